// What the command line changes in a scene file: `--set` assignments, and the keys of the file that they replace.
// Ranges of times become lists.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Each override is `table.key=value`, see apply_override. Returns a line for the user if a new run.start or run.until
/// leaves out times of the scene, else nothing. Throws Error for anything else.
std::string apply_overrides(Entries& entries, const std::vector<std::string>& overrides);

}  // namespace cradle::tools
