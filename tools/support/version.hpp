// What this program is: the version that results carry, and what --version says.
#pragma once

#include <string>

namespace cradle::tools {

inline constexpr const char* version = "0.1.0";

/// Version, compiler, options and the scalar types built in.
std::string build_description();

}  // namespace cradle::tools
