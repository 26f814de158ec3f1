// Particles of a list: whether the working precision of a run can hold their numbers, and whether they are in order.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// The numbers that the working precision of a run can hold. A larger number would become infinite and spoil the run; a
/// smaller one becomes 0, which is not allowed for masses.
class NumberRange {
 public:
  explicit NumberRange(const Run& run) : type_(scalar_row(run.precision)) {}

  /// Throws Error at `place` if a canonical decimal is too large.
  void check(std::string_view literal, const Place& place) const;
  /// The same if a positive one is too small.
  void check_positive(std::string_view literal, const Place& place) const;

 private:
  const ScalarRow& type_;
};

/// Positions are increasing; only neighbours that do not approach may be at one place. Masses are positive, or empty if
/// all are 1.
struct ListedParticles {
  DecimalColumn x, v, m;
};

/// Throws Error unless particle `right` of a list and the one before it are in order, and apart in the working
/// precision if they are not at one place. Those at one place must not approach: whether one of them collides before
/// with a third one would be open.
void check_neighbours(const DecimalColumn& x, const DecimalColumn& v, std::size_t right, const NumberRange& range,
                      const Place& place);

/// The same of all neighbours; `before` is the place of what is said of a particle and the one before it.
void check_order(const DecimalColumn& x, const DecimalColumn& v, const Run& run,
                 const std::function<Place(std::size_t)>& before);

}  // namespace cradle::tools
