// What this program is: the version that results carry, and what --version says.
#pragma once

#include <cstdint>
#include <string>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

inline constexpr const char* version = "0.1.0";

/// Of results: names of groups, columns and attributes. Format 1 had other names.
inline constexpr std::uint64_t format_version = 2;
/// The error for a file whose format is not the one read here.
Error of_version(const std::string& path, std::uint64_t found, std::uint64_t here = format_version);

/// Version, compiler, options and the scalar types built in.
std::string build_description();

}  // namespace cradle::tools
