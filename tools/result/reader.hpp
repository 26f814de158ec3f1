// Reads result files. The seal reveals damaged files (seal.hpp), and nothing in a file is trusted (reader.cpp).
#pragma once

#include <string>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

enum class Reading {
  everything,
  ends,  // only the first and the last row of every column
};

/// Throws Error (Exit::io) naming the file: missing, damaged, or not written by this program.
Result read_result(const std::string& path, Reading reading = Reading::everything);

}  // namespace cradle::tools
