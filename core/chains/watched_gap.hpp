#pragma once
// The cell of a gap in a chain of gaps and closing speeds, with the additional data of watched masses (masses.hpp).
//
// Exact sums, where masses are far apart (README.md, Masses far apart): the rest that rounding leaves of a closing
// speed is kept, w = closing + rest, with twice the digits, and a collision gives to the neighbours exactly what it
// takes from its own closing speed (gap_line.hpp).
//
// Deviations. Where particles nearly collapse and come apart again, errors grow by as many digits as gaps shrink, until
// they decide which collision is next. So two samples of how far a gap and its closing speed may be from those of the
// exact system are computed with the run, in units of epsilon. Every collision adds random errors of the size of
// rounding, which then obey the linearised motion. With D the deviation of a gap at a given time and d that of its
// closing speed,
//
//   flight of t         D -= d t
//   collision at gap s    D_s -> (w'/w) D_s,  D_p += (J/m_l w) D_s,  D_n += (J/m_r w) D_s,
//
// and d in the same way, with dw'/dw for w'/w where the restitution depends on the speed. A common delay tau of all
// events, D = tau w for all gaps, changes no sequence, but late in a collapse it would hide everything else. So
// whenever the origin of time moves, deviations are counted from the time of the last collision, which is then exact by
// definition; the sum of these delays is kept.
//
// A gap to a wall under gravity, or to a shaken wall, closes at a speed that grows at a rate a
// (laws/wall_approach.hpp). With w the speed at which it meets the wall, D_s/w is how much later the exact system has
// this collision, so
//
//   collision at the wall   dw = d_s + a D_s/w,   d_s -> (dw'/dw) dw - a D_s/w,   d_n += (J/m_r w) dw, ...
//
// and a delay tau adds a tau to d. A shaken wall moves with the time itself: where there is one, no delay is taken out.
//
// A collision is certain if `certain_by` times the larger sample changes neither that it happens (its closing speed
// stays positive) nor its place in the sequence: the gaps g beside it stay positive at its time, which is itself off by
// D_s/w, so |D_g - (w_g/w) D_s| < g. At the end of a run every gap must be positive with the same certainty. Then the
// collisions are those of the exact system (core/certify/README.md has the same argument with errors enclosed, not
// estimated).

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/base/fields.hpp"
#include "cradle/core/base/real.hpp"
#include "cradle/core/chains/timed_cells.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

// 32 bytes in double, two in a line of the cache.
template <Real T> struct alignas(std::same_as<T, double> ? 32 : alignof(T)) Gap : TimedGap<T> {
  T closing{-1};
  static auto state(auto& self) { return fields(TimedGap<T>::state(self), self.closing); }
};

// Deviations need few digits, but the range of the scalar type: gaps of 1e-1000 have smaller deviations.
template <Real T> using DeviationNumber = std::conditional_t<WiderRange<T>, T, double>;
template <Real T> auto deviation_number(const T& x) {
  if constexpr (WiderRange<T>)
    return x;
  else
    return to_double(x);
}

// Deviations of a gap at its local time, and of its closing speed; samples side by side.
template <Real N> struct Deviation {
  static constexpr std::size_t samples = 2;
  static constexpr int certain_by = 64;
  using Samples = std::array<N, samples>;
  Samples gap{N(0), N(0)}, closing{N(0), N(0)};

  Deviation after(const N& time) const {
    Deviation then = *this;
    for (std::size_t k = 0; k < samples; ++k) then.gap[k] -= closing[k] * time;
    return then;
  }
  void add(const Deviation& other, const N& share, const N& share_of_speed) {
    for (std::size_t k = 0; k < samples; ++k) {
      gap[k] += share * other.gap[k];
      closing[k] += share_of_speed * other.closing[k];
    }
  }
  // Counts it from a later time: every gap changes by the distance that it closes in the meantime, and its closing
  // speed by what it gains.
  void shift(const Samples& later, const N& closing_speed, const N& acceleration) {
    for (std::size_t k = 0; k < samples; ++k) {
      gap[k] -= closing_speed * later[k];
      closing[k] += acceleration * later[k];
    }
  }
  static N largest(const Samples& of) { return std::max<N>(magnitude(of[0]), magnitude(of[1])); }
  static auto state(auto& self) { return fields(self.gap[0], self.gap[1], self.closing[0], self.closing[1]); }
};

template <Real T> struct WatchedGap : Gap<T> {
  T rest{0};
  Deviation<DeviationNumber<T>> off;
  bool fits(const T& speed) const { return Gap<T>::fits(speed) && is_finite(rest); }
  static auto state(auto& self) { return fields(Gap<T>::state(self), self.rest, self.off); }
};

// Pseudo-random numbers from -1 to 1: either in sequence, the same for the same collisions; or for a given number,
// always the same, since it is rounded in the same way everywhere.
template <Real N> class Roundings {
 public:
  N next() {
    if (left_ == 0) bits_ = splitmix64(counter_ += step), left_ = 8;
    --left_;
    const N value = N(static_cast<int>(2 * (bits_ & 0xFF)) - 255) / N(256);
    bits_ >>= 8;
    return value;
  }
  static N of(double number, std::size_t sample) {
    const std::uint64_t bits = splitmix64(std::bit_cast<std::uint64_t>(number) + sample * step) >> 11;
    return N(static_cast<std::int64_t>(bits)) / N(std::int64_t{1} << 52) - N(1);
  }
  static auto state(auto& self) { return fields(self.counter_, self.bits_, self.left_); }

 private:
  static constexpr std::uint64_t step = 0x9E3779B97F4A7C15;
  std::uint64_t counter_ = 0, bits_ = 0, left_ = 0;
};

// The deviation of the gap right of a particle at the start, whose decimals were rounded.
template <Real T>
Deviation<DeviationNumber<T>> at_start(const Particles<T>& particles, ParticleIndex particle, ParticleIndex next) {
  using N = DeviationNumber<T>;
  const auto half_unit = [](const T& x, std::size_t sample) -> N {
    return Roundings<N>::of(to_double(x), sample) * magnitude(deviation_number(x)) / N(2);
  };
  Deviation<N> off;
  for (std::size_t k = 0; k < off.samples; ++k) {
    off.gap[k] = half_unit(particles.gap(particle), k) + half_unit(particles.rounded_place(next), k) -
                 half_unit(particles.rounded_place(particle), k);
    off.closing[k] = half_unit(particles.velocity(particle), k) - half_unit(particles.velocity(next), k);
  }
  return off;
}

}  // namespace cradle
