// What one key alone does not show: rows that do not meet, particles out of order, two ways to say the same thing,
// numbers that the working precision cannot hold.
#pragma once

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Throws Error at the place of the key to blame; `entries` say where the keys stand, `scene_file` where none does.
void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file);

}  // namespace cradle::tools
