// Checks that involve several keys: rows that do not meet, particles out of order, two settings for the same thing,
// numbers beyond the range of the working precision.
#pragma once

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Throws Error at the place of the wrong key. `entries` give the places of keys; `scene_file` names the file for keys
/// that are missing.
void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file);

/// The same for output.word, which is at this place, once the particles of a list are read.
void check_word(const Place& place, const Scene& scene);

}  // namespace cradle::tools
