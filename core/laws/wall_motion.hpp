#pragma once
// A wall is shaken about its place, which moves uniformly (wall.hpp): it is displaced towards the particles by A f(y),
// where y is the phase in turns, y = (omega t + phi)/2 pi, t the time since the start, and, for y from -1/2 to 1/2,
//
//   sawtooth   f = 2 y: always towards the particles at the speed A omega/pi; at y = 1/2 it jumps back by 2 A
//   parabola   f = 16 y (1/2 - |y|): arcs of the acceleration -+ 8 A omega^2/pi^2, with the speed 4 A omega/pi between
//   sine       f = sin(2 pi y)
//
// Phases are computed with twice the digits, so that they are right at any time. What the wall does within a flight is
// in wall_approach.hpp.

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

#include "cradle/core/base/require.hpp"
#include "cradle/core/laws/turns.hpp"

namespace cradle {

enum class Shape : std::uint8_t { sawtooth, parabola, sine };

// Whole turns and the rest, in [-1/2, 1/2): the sawtooth has jumped so many times.
template <Real T> struct Phase { T whole, rest; };

// Displacement, speed and acceleration towards the particles, at a phase.
template <Real T> struct Displaced { T place, speed, acceleration; };

// A shaken wall at a time since the start; turns as a sum.
template <Real T> struct WallMoment {
  Pair<T> elapsed, turns;
  Phase<T> phase;
  Displaced<T> wall;
};

template <Real T> class WallMotion {
 public:
  // The frequency is angular. Throws std::invalid_argument.
  WallMotion(Shape shape, const T& amplitude, const T& frequency, const T& phase)
      : shape_(shape), amplitude_(amplitude), frequency_(frequency), splitter_(splitter<T>()) {
    constexpr const char* out_of_range = " of a shaken wall is out of range (";
    require(is_positive(amplitude) && is_finite(amplitude), "amplitude", out_of_range, amplitude,
            "): give a positive one");
    require(is_positive(frequency) && is_finite(frequency), "frequency", out_of_range, frequency,
            "): give a positive one");
    require(is_finite(phase), "phase", out_of_range, phase, "): give a finite one");
    turns_per_time_ = quotient(Pair<T>{frequency, T(0)}, circle_.full_turn());
    turns_at_start_ = quotient(Pair<T>{phase, T(0)}, circle_.full_turn());
    const T turns = turns_per_time_.value();
    switch (shape) {
    case Shape::sawtooth:
      fastest_ = amplitude * T(T(2) * turns), curving_ = T(0);
      break;
    case Shape::parabola:
      fastest_ = amplitude * T(T(8) * turns), curving_ = T(4) * fastest_ * turns;
      break;
    case Shape::sine:
      fastest_ = amplitude * frequency, curving_ = fastest_ * frequency;
    }
  }

  Shape shape() const { return shape_; }
  // Whether it drops from under a particle that it pressed.
  bool jumps() const { return shape_ == Shape::sawtooth; }
  const T& amplitude() const { return amplitude_; }
  const T& frequency() const { return frequency_; }
  T period() const { return T(1) / turns_per_time_.value(); }
  const Circle<T>& circle() const { return circle_; }
  // The largest speed, and the largest acceleration.
  const T& fastest() const { return fastest_; }
  const T& curving() const { return curving_; }

  // At a time since the start, as a sum.
  Pair<T> turns_at(const Pair<T>& elapsed) const { return times(turns_per_time_, elapsed) + turns_at_start_; }
  Phase<T> at(const Pair<T>& elapsed) const { return phase(turns_at(elapsed)); }
  WallMoment<T> moment(const Pair<T>& elapsed) const {
    const Pair<T> turns = turns_at(elapsed);
    const Phase<T> now = phase(turns);
    return {elapsed, turns, now, at_phase(now.rest)};
  }
  T at_turns_of(const T& wait) const { return turns_per_time_.value() * wait; }

  // The phases that follow a time since the start, to the bit those of `at`, but sooner, where the processor has the
  // type: the turns after that time are added to those until then, with twice the digits, and nothing else is done
  // unless the errors of this and of `at` can show. Both are below 40 u^2 times the sum of all turns, u = epsilon/2 the
  // unit roundoff.
  class Following {
   public:
    Following(const WallMotion& motion, const Pair<T>& since, const Pair<T>& turns) : motion_(motion), since_(since) {
      if constexpr (std::floating_point<T>) {
        begin_ = turns - nearest_whole(turns.high);
        doubt_ = unit() * (magnitude(turns.high) + magnitude(motion.turns_at_start_.high) + T(1));
      }
    }
    T rest(const T& wait) const {
      if constexpr (std::floating_point<T>) {
        const Pair<T>& per_time = motion_.turns_per_time_;
        const Pair<T> more = exact_product(per_time.high, wait, motion_.splitter_);
        const Pair<T> turns = two_sum(begin_.high, more.high);
        const T high = turns.high - nearest_whole(turns.high);
        const T low = turns.low + (more.low + (begin_.low + per_time.low * wait));
        const T off = doubt_ + unit() * magnitude(more.high), least = high + (low - off), most = high + (low + off);
        if (least == most && magnitude(least) < T(1) / T(2)) [[likely]]
          return least;
      }
      return motion_.at(since_ + wait).rest;
    }

   private:
    static T unit() { return T(64) * T(std::numeric_limits<T>::epsilon()) * T(std::numeric_limits<T>::epsilon()); }
    const WallMotion& motion_;
    Pair<T> since_, begin_{};
    T doubt_{0};
  };

  // At a phase.
  Displaced<T> at_phase(const T& y) const {
    switch (shape_) {
    case Shape::sawtooth:
      return {T(amplitude_ * (y + y)), fastest_, T(0)};
    case Shape::parabola:
      return {T(T(16) * amplitude_ * y * (T(1) / T(2) - magnitude(y))), T(fastest_ * (T(1) - T(4) * magnitude(y))),
              is_negative(y) ? curving_ : T(-curving_)};
    case Shape::sine:
      break;
    }
    const UnitVector<T> turned = circle_.at_turns(y);
    return {T(amplitude_ * turned.sin), T(fastest_ * turned.cos), T(-(curving_ * turned.sin))};
  }
  // The phase from -1/4 to 1/2 at which it ceases to press a particle of this pull, or drops from under it; nothing if
  // it never does. On the sine this is where sin(2 pi y) = pull/(A omega^2). It is found by bisection, to the last bit:
  // for a small ratio s between s/8 and s/4, since halving towards 0 from afar would take as many steps as the type has
  // exponents.
  std::optional<T> release(const T& pull) const {
    switch (shape_) {
    case Shape::sawtooth:
      return T(1) / T(2);
    case Shape::parabola:
      return pull < curving_ ? std::optional(T(0)) : std::nullopt;
    case Shape::sine:
      if (!(pull < curving_)) return {};
      if (pull == T(0)) return T(0);
    }
    const T quarter = T(1) / T(4), ratio = pull / curving_;
    T low = -quarter, high = quarter;
    if (magnitude(ratio) < T(1) / T(1 << 30)) {
      const T near = ratio / T(8), far = ratio / T(4);
      low = is_negative(ratio) ? far : near, high = is_negative(ratio) ? near : far;
    }
    for (;;) {
      const T middle = (low + high) / T(2);
      if (!(low < middle && middle < high)) return high;
      (is_positive(T(pull + at_phase(middle).acceleration)) ? low : high) = middle;
    }
  }

 private:
  static Phase<T> phase(const Pair<T>& turns) {
    const auto beyond = [&](const T& whole) {
      if constexpr (std::floating_point<T>)
        return (turns.high - whole) + turns.low;  // the difference is exact
      else
        return (turns - whole).value();
    };
    T whole = nearest_whole(turns.high), rest = beyond(whole);
    if (rest < T(-1) / T(2)) whole -= T(1), rest = beyond(whole);
    if (!(rest < T(1) / T(2))) whole += T(1), rest = beyond(whole);
    return {whole, rest};
  }
  Pair<T> times(const Pair<T>& a, const Pair<T>& b) const {
    if constexpr (RoundsToNearest<T>)
      return exact_product(a.high, b.high, splitter_) + T(a.high * b.low + a.low * b.high);
    else
      return two_sum(T(a.high * b.high), T(a.high * b.low + a.low * b.high));
  }

  Shape shape_;
  T amplitude_, frequency_, splitter_, fastest_{0}, curving_{0};
  Circle<T> circle_;
  Pair<T> turns_per_time_, turns_at_start_;
};

}  // namespace cradle
