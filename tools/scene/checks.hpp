// What a scene must be like. keys.cpp checks that its keys are known and apply to its law, initial state and policy.
// checks_of_state.cpp and checks.cpp check what several keys say together: they refuse rows that do not meet, particles
// out of order, two settings for the same thing, and numbers beyond the range of the working precision.
#pragma once

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Makes one entry, a table, of all entries inside what is a key: it is refused where the key is read, when the numbers
/// that its range depends on are known. Ranges of times are lists already.
void gather_tables(Entries& entries);

/// Throws Error for the first unknown key, with the most similar known one.
void refuse_unknown_keys(const Entries& entries);

/// Throws Error for the first key that does not apply to this scene, with the reason. Checks the keys that depend on
/// `decider`, or all keys if it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {});

/// Throws Error at the place of the wrong key. `entries` give the places of keys; `scene_file` names the file for keys
/// that are missing.
void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file);

}  // namespace cradle::tools
