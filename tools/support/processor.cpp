// Ends the program with one message on a processor that lacks the instructions that the rest of the program is compiled
// for (CRADLE_ARCH). It runs before everything else, and is itself compiled for any x86-64.
#include <unistd.h>

#include <string_view>

#include "cradle/tools/support/errors.hpp"

namespace {

__attribute__((no_sanitize("address"), no_sanitize("undefined"), no_sanitize("thread"))) void require_instructions() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
      __builtin_cpu_supports("fma"))
    return;
  constexpr std::string_view message =
      "cradle: this processor cannot run the program (it lacks AVX2, BMI2 or FMA, which x86-64-v3 has): build with "
      "`cmake --preset portable && cmake --build --preset portable`, whose program gives the same bits\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message.data(), message.size());
  _exit(static_cast<int>(cradle::tools::Exit::processor));
}

// Runs before all initialisers, those of libraries included. Only hang_ups.cpp, linked earlier, comes before it, and is
// compiled for any x86-64 as well.
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = require_instructions;

}  // namespace
