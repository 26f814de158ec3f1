// Messages and progress, on standard error. Where nobody is there to read them (the terminal is gone) work continues.
#pragma once

#include <cstdio>
#include <string_view>

namespace cradle::tools {

inline void notify(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace cradle::tools
