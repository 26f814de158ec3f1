#pragma once
// The gap between a wall and a particle with a constant acceleration. With the closing speed w, the gap g and the pull
// p, the rate at which w grows,
//
//   g(t) = g - w t - p t^2/2,   w(t) = w + p t,   p > 0: a floor, towards which particles fall; p < 0: a ceiling.
//
// With D = w^2 + 2 p g the particle is at the wall at the speed s = sqrt(D), and the time until then is, without
// cancellation,
//
//   w >= 0   t = 2 g/(w + s)
//   w <  0   t = (s - w)/p; after a collision, g = 0, the speed is just -w; never at a ceiling.
//
// A floor is always met; a ceiling if w > 0 and D > 0 (at D = 0 the particle touches it without speed, which changes
// nothing). There D cancels: products are computed with twice the digits, so that its sign is that of the given
// numbers. A Newton step, also with twice the digits, then leaves the time with little more than its own rounding.
// (Double-double has digits to spare and does without both.)

#include <cmath>
#include <limits>
#include <optional>

#include "cradle/core/base/real.hpp"

namespace cradle {

// A type in which products can be had without error.
template <class T>
concept RoundsToNearest = requires {
  requires std::numeric_limits<T>::round_style == std::round_to_nearest;
  requires !std::numeric_limits<T>::is_exact;
};

// 2^k + 1, which splits a number of p digits into two of at most p/2: k is p/2, rounded up.
template <Real T> T splitter() {
  T power(1);
  const T epsilon = std::numeric_limits<T>::epsilon();
  if (epsilon == T(0)) return T(1);  // nothing is rounded
  while (power * power * epsilon < T(2)) power += power;
  return power + T(1);
}
// The product a b without error, if neither it nor its rest leaves the range of the type (Dekker, Numer. Math. 18, 224,
// 1971, doi 10.1007/BF01397083).
template <RoundsToNearest T> Pair<T> exact_product(const T& a, const T& b, const T& splitter) {
  const auto halves = [&](const T& x) {
    const T scaled = splitter * x, high = scaled - (scaled - x);
    return Pair<T>{high, T(x - high)};
  };
  const Pair<T> l = halves(a), r = halves(b);
  const T product = a * b;
  return {product, T(((l.high * r.high - product) + l.high * r.low + l.low * r.high) + l.low * r.low)};
}
#ifdef __FMA__
// Fused operations give the same bits where the rest is in range.
inline Pair<double> exact_product(double a, double b, double splitter) {
  const double product = a * b, size = std::abs(product);
  if (!(size > 0x1p-900 && size < 0x1p900 && std::abs(a) < 0x1p900 && std::abs(b) < 0x1p900)) [[unlikely]]
    return exact_product<double>(a, b, splitter);
  return {product, std::fma(a, b, -product)};
}
#endif

// A collision: the time until then, and its speed.
template <Real T> struct WallMeeting { T in, speed; };

template <Real T> class Approach {
 public:
  // gap, closing speed and pull as above, the pull not 0; `splitter` as made by splitter().
  Approach(const T& gap, const T& closing, const T& pull, const T& splitter)
      : gap_(gap), closing_(closing), pull_(pull), splitter_(splitter) {}

  // After a time: the closing speed, its mean until then, and the gap.
  T closing_after(const T& time) const { return closing_ + pull_ * time; }
  T mean_closing(const T& time) const { return closing_ + pull_ * time / T(2); }
  T gap_after(const T& time) const { return gap_ - mean_closing(time) * time; }
  const T& pull() const { return pull_; }

  // When the particle meets the wall, and how fast; nothing if it does not. A gap that rounding has left below zero is
  // met in the past if it closes, and at a floor also where it will have the same size again.
  std::optional<WallMeeting<T>> meeting() const {
    const std::optional<T> speed = meeting_speed();
    if (!speed) return {};
    const T time = time_at(*speed);
    return WallMeeting<T>{at_rest_or_leaving() || time == T(0) ? time : refined(time, *speed), *speed};
  }
  // That time to a few units, sooner.
  std::optional<T> roughly_in() const {
    const std::optional<T> speed = meeting_speed();
    return speed ? std::optional<T>(time_at(*speed)) : std::nullopt;
  }

 private:
  bool at_rest_or_leaving() const { return gap_ == T(0) && !is_positive(closing_); }
  std::optional<T> meeting_speed() const {
    if (at_rest_or_leaving() && is_positive(pull_)) return T(-closing_);
    if (!is_positive(pull_) && !is_positive(closing_)) return {};
    const T speed = speed_there();
    if (is_positive(speed)) return speed;
    if (is_positive(pull_)) return magnitude(closing_);
    return {};
  }

  T time_at(const T& speed) const {
    const T sum = speed + magnitude(closing_);
    if (at_rest_or_leaving() || is_negative(closing_)) return sum / pull_;
    return is_positive(sum) ? T((gap_ + gap_) / sum) : T(0);
  }
  // The root of D, 0 if D is negative.
  T speed_there() const {
    const T least =
        T(std::numeric_limits<T>::min()) / T(std::numeric_limits<T>::epsilon()) / T(std::numeric_limits<T>::epsilon());
    const T twice = pull_ + pull_, square = closing_ * closing_, fall = twice * gap_;
    if (square < least && magnitude(fall) < least) {  // squares lose digits: compute with roots
      const T own = magnitude(closing_), of_fall = square_root(magnitude(twice)) * square_root(magnitude(gap_));
      if (is_negative(pull_) != is_negative(gap_))
        return of_fall < own ? T(square_root(T(own - of_fall)) * square_root(T(own + of_fall))) : T(0);
      const T &large = own < of_fall ? of_fall : own, &small = own < of_fall ? own : of_fall;
      if (!is_positive(large)) return T(0);
      const T ratio = small / large;
      return large * square_root(T(T(1) + ratio * ratio));
    }
    T all = square + fall;
    if constexpr (RoundsToNearest<T>) {
      const Pair<T> sum = exact_product(closing_, closing_, splitter_) + exact_product(twice, gap_, splitter_);
      if (is_finite(sum.low)) all = sum.value();
    }
    return is_positive(all) ? square_root(all) : T(0);
  }

  // A Newton step from a time that is right up to a few units. At a touch the speed there is so small that it would
  // lead away.
  T refined(const T& time, const T& speed) const {
    if constexpr (RoundsToNearest<T>) {
      const Pair<T> mean = exact_product(T(pull_ / T(2)), time, splitter_) + closing_;
      const Pair<T> way = exact_product(mean.high, time, splitter_) + T(mean.low * time);
      const T step = (-way + gap_).value() / speed;
      if (magnitude(step) < T(8) * T(std::numeric_limits<T>::epsilon()) * magnitude(time)) return time + step;
    }
    return time;
  }

  T gap_, closing_, pull_, splitter_;
};

}  // namespace cradle
