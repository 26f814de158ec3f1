// What the program does in Python: pictures and reports. It carries the package tools/python/cradle in itself, so that
// both work wherever it is installed.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

struct EmbeddedFile {
  std::string_view name, text;  // the name with the folders below tools/python
};

/// The package, written by embed.cmake.
std::span<const EmbeddedFile> python_package();

struct PageArguments {
  std::string file, output;
};

/// Runs the package's `cradle COMMAND FILE -o OUTPUT` from a temporary folder and returns its status, that of bad input
/// or of files; the output is by default FILE without .part and with another extension. `what` names what is made ("the
/// picture"); throws Error (Exit::io) where FILE is damaged or there is no Python for it.
Exit run_python(const std::string& command, const PageArguments& arguments, const char* extension,
                std::string_view what);

}  // namespace cradle::tools
