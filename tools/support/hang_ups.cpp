// Reads whether the program was started under nohup. Some libraries take over signals before main() (UCX, which MPI
// uses, takes SIGHUP), so this is read before their code runs, with a plain system call, since nothing is initialised
// yet.
#include <csignal>

#include "cradle/tools/support/interrupt.hpp"

#ifdef __linux__
#include <sys/syscall.h>
#include <unistd.h>

namespace cradle::tools {

namespace {

__attribute__((no_sanitize("address"), no_sanitize("undefined"), no_sanitize("thread"))) void check_hang_ups() {
  unsigned long action[4] = {};  // the handler first
  if (::syscall(SYS_rt_sigaction, SIGHUP, nullptr, action, sizeof action[3]) == 0)
    hang_ups_ignored = action[0] == reinterpret_cast<unsigned long>(SIG_IGN);
}
[[gnu::section(".preinit_array"), gnu::used]] void (*const first_of_all)() = check_hang_ups;

}  // namespace

}  // namespace cradle::tools
#endif
