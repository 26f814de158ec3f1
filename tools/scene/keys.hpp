// Which keys a scene may contain: known keys that apply to its law, initial state and policy.
#pragma once

#include <string_view>

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Throws Error for the first unknown key, with the most similar known one.
void refuse_unknown_keys(const Entries& entries, const Scene& scene);

/// Throws Error for the first key that does not apply to this scene, with the reason. Checks the keys that depend on
/// `decider`, or all keys if it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {});

}  // namespace cradle::tools
