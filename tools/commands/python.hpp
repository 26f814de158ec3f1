// The Python package that the program contains.
#pragma once

#include <span>
#include <string_view>

namespace cradle::tools {

struct EmbeddedFile {
  std::string_view name, text;  // the name includes the folders below tools/python
};

/// The package, written by embed.cmake.
std::span<const EmbeddedFile> python_package();

}  // namespace cradle::tools
