// What the command line sets on top of a scene file: `--set` assignments, and what of the file gives way to them.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Each override is `table.key=value`, see apply_override. Throws Error for what is no assignment.
void apply_overrides(Entries& entries, const std::vector<std::string>& overrides);

}  // namespace cradle::tools
