// What the program does in Python: pictures and reports. It carries the package tools/python/cradle in itself, so that
// both work wherever it is installed, and runs it from a temporary folder with a Python that has what it needs.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

struct EmbeddedFile {
  std::string_view name, text;  // the name with the folders below tools/python
};

/// The package, written by embed.cmake.
std::span<const EmbeddedFile> python_package();

/// A folder that is gone, with its files, when its owner is. Throws Error (Exit::io) where there is no room for it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Makes folders in the name where they are missing; returns the file's path.
  std::string write(std::string_view name, std::string_view text) const;

 private:
  Error no_room() const;

  std::string path_;
};

/// Runs `cradle WORDS...` of the package, written into the folder, and returns its status, that of bad input or of
/// files. `what` names what is made ("the picture"); throws Error (Exit::io) where there is no Python for it or it
/// fails.
Exit run_python(const TemporaryFolder& folder, const std::vector<std::string>& words, const std::string& file,
                std::string_view what);

}  // namespace cradle::tools
