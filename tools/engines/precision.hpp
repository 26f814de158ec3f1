// The precision of a scene, for code that is the same for all scalar types.
#pragma once

#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// "double", "mpfr, 50 digits", ...
std::string precision_name(const Run& run);

/// Sets MPFR's number of digits, of which a process has one at a time, if the scene's numbers are of that type. Throws
/// Error for a type that this build does not have.
void set_digits(const Scene& scene);

}  // namespace cradle::tools
