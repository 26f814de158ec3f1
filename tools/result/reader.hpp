// Result files read back. A damaged file is refused by its seal (seal.hpp). Nothing in a file is believed: names,
// types, shapes and sizes are checked before anything is done with them.
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
