// What the program does in Python: pictures and reports. The program contains the package tools/python/cradle, so both
// work wherever the program is installed.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

struct EmbeddedFile {
  std::string_view name, text;  // the name includes the folders below tools/python
};

/// The package, written by embed.cmake.
std::span<const EmbeddedFile> python_package();

struct PageArguments {
  std::string file, output;
  bool forced = false;
};

/// Runs the package's `cradle COMMAND FILE -o OUTPUT [--force]` from a temporary folder. Returns its status if that is
/// one of bad input or files. The default output is FILE without .part and with another extension. `what` names the
/// product ("the picture"). Throws Error (Exit::io) if FILE is damaged or no suitable Python is found.
Exit run_python(const std::string& command, const PageArguments& arguments, const char* extension,
                std::string_view what);

}  // namespace cradle::tools
