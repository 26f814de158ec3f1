// Runs before main() and all initialisers, those of libraries included, and is compiled for any x86-64. It reads
// whether the program was started under nohup: some libraries take over signals before main() (UCX, which MPI uses,
// takes SIGHUP). Nothing is initialised yet, so that is a plain system call. Then it ends the program with one message
// on a processor that lacks the instructions that the rest of the program is compiled for (CRADLE_ARCH).
#ifdef __linux__
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

namespace {

__attribute__((no_sanitize("address"), no_sanitize("undefined"), no_sanitize("thread"))) void before_main() {
  unsigned long action[4] = {};  // the handler first
  if (::syscall(SYS_rt_sigaction, SIGHUP, nullptr, action, sizeof action[3]) == 0)
    hang_ups_ignored = action[0] == reinterpret_cast<unsigned long>(SIG_IGN);
#ifdef CRADLE_NEEDS_X86_64_V3
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
      __builtin_cpu_supports("fma"))
    return;
  constexpr std::string_view message =
      "cradle: this processor cannot run the program (it lacks AVX2, BMI2 or FMA, which x86-64-v3 has): build with "
      "`cmake --preset portable && cmake --build --preset portable`, whose program gives the same bits\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
  ::_exit(static_cast<int>(Exit::processor));
#endif
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = before_main;

}  // namespace

}  // namespace cradle::tools
#endif
