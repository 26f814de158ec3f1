#include "cradle/tools/support/interrupt.hpp"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace cradle::tools {

namespace {

// What a handler may write to is global, and lock-free where all threads read it.
std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void note(int signal) { noted = signal; }

}  // namespace

void note_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, note);
}

int noted_signal() { return noted; }

void note_signal(int signal) { note(signal); }

}  // namespace cradle::tools
