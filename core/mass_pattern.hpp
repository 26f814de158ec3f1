#pragma once
// Masses that repeat along the bodies, counted from body 0 on: body b has the mass of entry b mod k. No entries: all
// masses are 1, and nothing is asked of the pattern that would cost more than a one.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/bodies.hpp"

namespace cradle {

template <Real T> class MassPattern {
 public:
  MassPattern() = default;
  // `identical`: whether they are all one number; nothing: as the type tells. Who has them in more digits than the type
  // says so, since the velocities of a ring depend on it (ring.hpp). Throws std::invalid_argument for masses that are
  // not positive and finite.
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

  BodyIndex period() const { return masses_.empty() ? 1 : static_cast<BodyIndex>(masses_.size()); }
  bool identical() const { return identical_; }
  T of(BodyIndex body) const { return masses_.empty() ? T(1) : masses_[static_cast<std::size_t>(body % period())]; }
  T least() const { return masses_.empty() ? T(1) : *std::min_element(masses_.begin(), masses_.end()); }
  T greatest() const { return masses_.empty() ? T(1) : *std::max_element(masses_.begin(), masses_.end()); }
  // Of bodies [from, to): how many there are of each entry, times its mass.
  T total(BodyIndex from, BodyIndex to) const {
    if (masses_.empty()) return T(to - from);
    CompensatedSum<T> sum;
    for (BodyIndex entry = 0; entry < period(); ++entry) sum.add(T(times(entry, to) - times(entry, from)) * of(entry));
    return sum.value();
  }

 private:
  // How many bodies before `end` have the mass of an entry.
  BodyIndex times(BodyIndex entry, BodyIndex end) const { return (end - entry + period() - 1) / period(); }

  std::vector<T> masses_;
  bool identical_ = true;
};

}  // namespace cradle
