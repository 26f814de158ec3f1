// Messages and progress, on standard error. If nobody can read them (the terminal has closed) work continues.
#pragma once

#include <cstdio>
#include <string_view>

namespace cradle::tools {

inline void notify(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace cradle::tools
