// Particles of a list, and whether they are in order.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "cradle/tools/scene/number_range.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Positions are increasing; only neighbours that do not approach may be at one place. Masses are positive, or empty if
/// all are 1.
struct ListedParticles {
  DecimalColumn x, v, m;
};

/// A particle of a list.
struct Listed {
  std::string_view x, v;
};

/// Throws Error unless neighbours are in order, and apart in the working precision if they are not at one place. Those
/// at one place must not approach: whether one of them collides before with a third one would be open.
void check_neighbours(const Listed& left, const Listed& right, const NumberRange& range, const Place& place);

/// The same of all neighbours; `before` is the place of what is said of a particle and the one before it.
void check_order(const ListedParticles& of, const Run& run, const std::function<Place(std::size_t)>& before);

}  // namespace cradle::tools
