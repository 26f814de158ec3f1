// A summary of a result: scene, precision, times, counts.
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// "key = value" line by line; `all`: also keys at their defaults.
std::string listing(const Scene& scene, bool all);

/// Needs only the first and last rows of the columns. Throws Error if `file` holds no scene.
std::string listing(const Result& result, const std::string& file, bool all);

}  // namespace cradle::tools
