#pragma once
// Two classes measure how particles are placed with respect to each other at one time, from their positions x on a
// length L: a ring, or between two walls. Lengths are in units of the scene; numbers are float64.
//
//   structure factor    S(k) = |sum m exp(i k x)|^2/sum m^2, k = 2 pi n/L; particles that have merged count as one
//   pair distribution   g(r) = pairs at a distance in a bin about r, divided by their mean number if the same particles
//                       are at independent, uniform places: N (N - 1)/2 (F(r_high) - F(r_low)), with the share F(r) of
//                       distances below r, 2 r/L on a ring (r <= L/2), (2 - r/L) r/L between walls
//
// Both are 1 for particles at independent places. The phase k x has an error of 2^-52 n |x|/L turns.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "cradle/core/laws/turns.hpp"
#include "cradle/core/observe/histograms.hpp"
#include "cradle/core/observe/profile.hpp"

namespace cradle {

inline constexpr BinRange whole_line{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

class StructureFactor {
 public:
  // For n up to `largest`. Throws std::invalid_argument for a length that is not positive and finite.
  StructureFactor(double length, std::uint64_t largest) : length_(length), waves_(octave_steps(largest)) {
    require(length > 0 && std::isfinite(length), "waves on no length (", length, "): give a positive length");
  }

  std::vector<double> wave_numbers() const {
    std::vector<double> k;
    for (const std::uint64_t n : waves_) k.push_back(2 * std::numbers::pi * static_cast<double>(n) / length_);
    return k;
  }

  // S for each of these. If `stopped` stops the loop, it throws WalkStopped (see for_each_particle).
  template <Real T>
  std::vector<double> operator()(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed,
                                 const std::function<bool()>& stopped = {}) const {
    std::vector<double> turns, masses, all;
    double squares = 0;
    const auto see = [&](double x, double, double m) {
      turns.push_back(x / length_);
      masses.push_back(m);
      squares += m * m;
    };
    for_each_particle(c, particles, elapsed, whole_line, see, stopped);
    for (const std::uint64_t n : waves_) {
      if (stopped && stopped()) throw WalkStopped();
      double real = 0, imaginary = 0;
      for (std::size_t j = 0; j < turns.size(); ++j) {
        const UnitVector at = at_turns(static_cast<double>(n) * turns[j]);
        real += masses[j] * at.cos;
        imaginary += masses[j] * at.sin;
      }
      all.push_back((real * real + imaginary * imaginary) / squares);
    }
    return all;
  }

 private:
  double length_;
  std::vector<std::uint64_t> waves_;
};

class PairDistribution {
 public:
  // In bins of equal width up to a distance. Throws std::invalid_argument for no bins, or a distance that is not
  // positive or longer than half of a ring or the length between walls.
  PairDistribution(double distance, std::size_t bins, double length, bool on_ring)
      : distance_(distance), length_(length), on_ring_(on_ring), bins_(bins) {
    require(distance > 0 && distance <= (on_ring ? length / 2 : length) && bins > 0, "pairs up to a distance of ",
            distance, " on a length of ", length, ": give half of a ring at most, and at least one bin");
  }

  std::vector<double> centres() const { return bin_centres({0, distance_}, bins_); }

  // g in each bin; NaN for a single particle, which has no pair. If `stopped` stops the loop, it throws WalkStopped.
  template <Real T>
  std::vector<double> operator()(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed,
                                 const std::function<bool()>& stopped = {}) const {
    std::vector<double> x;
    for_each_particle(
        c, particles, elapsed, whole_line, [&](double place, double, double) { x.push_back(place); }, stopped);
    std::sort(x.begin(), x.end());
    const std::size_t count = x.size();
    std::vector<std::uint64_t> pairs(bins_);
    for (std::size_t i = 0; i < count; ++i) {
      constexpr std::size_t between_stops = 1 << 10;
      if (i % between_stops == 0 && stopped && stopped()) throw WalkStopped();
      for (std::size_t j = i + 1; on_ring_ || j < count; ++j) {
        const double apart = j < count ? x[j] - x[i] : x[j - count] - x[i] + length_;
        if (!(apart < distance_)) break;
        ++pairs[detail::bin_at(apart / distance_ * static_cast<double>(bins_), bins_)];
      }
    }
    const auto particle_count = static_cast<double>(count);
    const double all = count > 1 ? particle_count * (particle_count - 1) / 2 : std::numeric_limits<double>::quiet_NaN();
    std::vector<double> g;
    for (std::size_t bin = 0; bin < bins_; ++bin)
      g.push_back(static_cast<double>(pairs[bin]) / (all * (share_below(bin + 1) - share_below(bin))));
    return g;
  }

 private:
  // F at the beginning of a bin.
  double share_below(std::size_t bin) const {
    const double part = distance_ * static_cast<double>(bin) / static_cast<double>(bins_) / length_;
    return on_ring_ ? 2 * part : (2 - part) * part;
  }

  double distance_, length_;
  bool on_ring_;
  std::size_t bins_;
};

}  // namespace cradle
