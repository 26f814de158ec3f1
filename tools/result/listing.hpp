// What a result holds, in words: scene, precision, times, counts.
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// "key = value" line by line; `all`: also what does not differ from the defaults.
std::string listing(const Scene& scene, bool all);

/// Columns need no more than their first and last rows. Throws Error where `file` holds no scene.
std::string listing(const Result& result, const std::string& file, bool all);

}  // namespace cradle::tools
