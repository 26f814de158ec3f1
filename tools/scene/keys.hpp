// Which keys a scene may contain: known keys that apply to its law, initial state and policy.
#pragma once

#include <string_view>

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

}  // namespace cradle::tools
