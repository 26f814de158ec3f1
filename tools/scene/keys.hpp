// Which keys may stand in a scene: known ones, and of these only those that apply to its law, initial state and policy.
#pragma once

#include <string_view>

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Throws Error for the first key that is none, with the one most like it.
void refuse_unknown_keys(const Entries& entries, const Scene& scene);

/// Throws Error for the first key that says nothing in this scene, with the reason: of the keys that `decider` decides
/// on, or of all where it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {});

}  // namespace cradle::tools
