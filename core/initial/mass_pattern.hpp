#pragma once
// Masses that repeat along the particles, counted from particle 0: particle b has the mass of entry b mod k. Without
// entries all masses are 1, at the cost of a constant. Random masses are a pattern as long as the particles: entry b is
// a + n (c - a) 2^-28, uniform between a and c, with a whole number n of 0 to 2^28 that is keyed by seed, replica and
// particle: the same in every scalar type. Only sums of n are held, so that the mass of any stretch takes no pass.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> class MassPattern {
 public:
  MassPattern() = default;
  // `identical`: whether all masses are the same number; by default they are compared in the type. Callers that know
  // more digits than the type has must give it, since the velocities of a ring depend on it (gas.hpp). Throws
  // std::invalid_argument for masses that are not positive and finite.
  explicit MassPattern(std::vector<T> masses, std::optional<bool> identical = {}) : masses_(std::move(masses)) {
    for (std::size_t j = 0; j < masses_.size(); ++j) {
      require_finite(masses_[j], "mass ", j, " of the pattern");
      require(masses_[j] > T(0), "mass ", j, " of the pattern is not positive (", masses_[j],
              "): give positive masses");
      identical_ = identical_ && masses_[j] == masses_[0];
    }
    if (identical) identical_ = *identical;
    if (masses_.empty()) return;
    least_ = *std::min_element(masses_.begin(), masses_.end());
    greatest_ = *std::max_element(masses_.begin(), masses_.end());
  }

  // Random masses. Throws std::invalid_argument unless 0 < least < greatest < infinity and 0 < count < 2^31.
  MassPattern(const T& least, const T& greatest, ParticleIndex count, std::uint64_t seed, std::uint64_t replica)
      : masses_{least, greatest}, identical_(false), unit_((greatest - least) / T(drawn_unit)) {
    require_finite(greatest, "greatest of the random masses");
    require(least > T(0) && greatest > least, "random masses from ", least, " to ", greatest,
            ": give two positive masses, the smaller one first");
    require(count >= 1 && count < std::int64_t{1} << 31, "random masses of ", count,
            " particles: give from 1 to 2147483647");
    std::vector<std::int64_t> sums{0};
    sums.reserve(static_cast<std::size_t>(count) + 1);
    std::int64_t low = drawn_unit, high = 0;
    for (ParticleIndex particle = 0; particle < count; ++particle) {
      // Indices that no velocity, no gap and no wall has (gas.hpp, poisson.hpp, wall.hpp).
      const std::uint64_t index = static_cast<std::uint64_t>(particle) | std::uint64_t{0xFC} << 56;
      const std::int64_t n = uniform_integer(random_bits(seed, replica, index), drawn_unit / 2) + drawn_unit / 2;
      low = std::min(low, n), high = std::max(high, n);
      sums.push_back(sums.back() + n);
    }
    sums_ = std::make_shared<const std::vector<std::int64_t>>(std::move(sums));
    least_ = drawn(low), greatest_ = drawn(high);
  }

  ParticleIndex period() const {
    if (sums_) return static_cast<ParticleIndex>(sums_->size()) - 1;
    return masses_.empty() ? 1 : static_cast<ParticleIndex>(masses_.size());
  }
  bool identical() const { return identical_; }
  T of(ParticleIndex particle) const {
    if (sums_) return drawn(sum_of(particle, particle + 1));
    return masses_.empty() ? T(1) : masses_[static_cast<std::size_t>(particle % period())];
  }
  T least() const { return least_; }
  T greatest() const { return greatest_; }
  // The mass of particles [from, to): the sum over entries of number times mass.
  T total(ParticleIndex from, ParticleIndex to) const {
    if (sums_) return T(to - from) * masses_[0] + T(sum_of(from, to)) * unit_;
    if (masses_.empty()) return T(to - from);
    CompensatedSum<T> sum;
    for (ParticleIndex entry = 0; entry < period(); ++entry)
      sum.add(T(times(entry, to) - times(entry, from)) * of(entry));
    return sum.value();
  }

 private:
  static constexpr std::int64_t drawn_unit = std::int64_t{1} << 28;

  T drawn(std::int64_t n) const { return masses_[0] + T(n) * unit_; }
  std::int64_t sum_of(ParticleIndex from, ParticleIndex to) const {
    return (*sums_)[static_cast<std::size_t>(to)] - (*sums_)[static_cast<std::size_t>(from)];
  }
  // The number of particles before `end` that have the mass of an entry.
  ParticleIndex times(ParticleIndex entry, ParticleIndex end) const { return (end - entry + period() - 1) / period(); }

  std::vector<T> masses_;  // of random masses: the two between which they are
  bool identical_ = true;
  std::shared_ptr<const std::vector<std::int64_t>> sums_;  // of random masses, over the particles before each one
  T unit_{0};                                              // of random masses
  T least_{1}, greatest_{1};
};

}  // namespace cradle
