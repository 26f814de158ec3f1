// The distance of the first and the last particle to a wall, and its closing speed, from the scene's decimals: a
// difference of rounded positions may have no correct digit.
#pragma once

#include <optional>
#include <string>

#include "cradle/core/initial/rows.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Decimals, exact or with so many digits that they are rounded to the same number in the working precision. Without a
/// closing speed the particle's velocity is no number of the scene.
struct AtWallText {
  std::string gap;
  std::optional<std::string> closing_speed;
};

/// Of the particle beside the wall at this end, if there is one; in its place if the wall is shaken. Only for lists,
/// rows and cold gases. `displacement` is that of the scene's particles (null for a list).
std::optional<AtWallText> at_wall(const Scene& scene, End end, const Displacement& displacement);

}  // namespace cradle::tools
