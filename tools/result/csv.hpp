// Exports a result as text: one CSV file per group, and the scene, ready to be run again.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// One line per row, with enough digits to read the same number back. Shorter columns (gaps of n particles) leave their
/// last fields empty. Attributes come first, as comments.
std::string csv(const Group& group);

/// Writes GROUP.csv for every group below `folder`, and scene.toml if there is a scene: that of the file, and those of
/// a sweep's points; files.txt lists them. Returns the paths. What was exported there before from the result named `of`
/// is removed; anything else in the way is refused (Exit::bad_input) unless forced. Throws Error (Exit::io).
std::vector<std::string> export_csv(const Result& result, const std::string& folder, const std::string& of = "",
                                    bool forced = false);

}  // namespace cradle::tools
