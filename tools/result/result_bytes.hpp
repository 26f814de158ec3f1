// A result as bytes and back, to hand it from one process to another.
#pragma once

#include <string>
#include <string_view>

#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

std::string to_bytes(const Result& result);
Result result_of_bytes(std::string_view bytes);

}  // namespace cradle::tools
