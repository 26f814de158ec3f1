// A result as text: one CSV file per group, and the scene beside them, ready to be run again.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// One line per row, as many digits as it takes to read the same number back. Columns that are shorter (gaps of n
/// particles) leave their last fields empty; attributes come first, as comments.
std::string csv(const Group& group);

/// Writes GROUP.csv for every group below `folder`, and scene.toml where there is a scene: that of the file, those of a
/// sweep's points. Returns the files' paths. Throws Error (Exit::io).
std::vector<std::string> export_csv(const Result& result, const std::string& folder);

}  // namespace cradle::tools
