#pragma once
// Masses that repeat along the particles, counted from particle 0: particle b has the mass of entry b mod k. Without
// entries all masses are 1, at the cost of a constant.

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> class MassPattern {
 public:
  MassPattern() = default;
  // `identical`: whether all masses are the same number; by default they are compared in the type. Callers that know
  // more digits than the type has must give it, since the velocities of a ring depend on it (ring.hpp). Throws
  // std::invalid_argument for masses that are not positive and finite.
  explicit MassPattern(std::vector<T> masses, std::optional<bool> identical = {}) : masses_(std::move(masses)) {
    for (std::size_t j = 0; j < masses_.size(); ++j) {
      require_finite(masses_[j], "mass " + std::to_string(j) + " of the pattern");
      if (!(masses_[j] > T(0)))
        throw std::invalid_argument("mass " + std::to_string(j) + " of the pattern is not positive (" +
                                    in_message(masses_[j]) + "): give positive masses");
      identical_ = identical_ && masses_[j] == masses_[0];
    }
    if (identical) identical_ = *identical;
  }

  ParticleIndex period() const { return masses_.empty() ? 1 : static_cast<ParticleIndex>(masses_.size()); }
  bool identical() const { return identical_; }
  T of(ParticleIndex particle) const {
    return masses_.empty() ? T(1) : masses_[static_cast<std::size_t>(particle % period())];
  }
  T least() const { return masses_.empty() ? T(1) : *std::min_element(masses_.begin(), masses_.end()); }
  T greatest() const { return masses_.empty() ? T(1) : *std::max_element(masses_.begin(), masses_.end()); }
  // The mass of particles [from, to): the sum over entries of number times mass.
  T total(ParticleIndex from, ParticleIndex to) const {
    if (masses_.empty()) return T(to - from);
    CompensatedSum<T> sum;
    for (ParticleIndex entry = 0; entry < period(); ++entry)
      sum.add(T(times(entry, to) - times(entry, from)) * of(entry));
    return sum.value();
  }

 private:
  // The number of particles before `end` that have the mass of an entry.
  ParticleIndex times(ParticleIndex entry, ParticleIndex end) const { return (end - entry + period() - 1) / period(); }

  std::vector<T> masses_;
  bool identical_ = true;
};

}  // namespace cradle
