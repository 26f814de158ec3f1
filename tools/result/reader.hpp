// Result files read back. Nothing in them is believed: names, types, shapes and sizes are checked before anything is
// done with them, and a file that is not known to be intact (seal.hpp) is read in a process of its own (guarded.hpp).
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

enum class Reading {
  everything,
  ends,  // of every column the first and the last row only
};

/// Throws Error (Exit::io) naming the file: missing, damaged, or not written by this program.
Result read_result(const std::string& path, Reading reading = Reading::everything);

}  // namespace cradle::tools
