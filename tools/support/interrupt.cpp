#include "cradle/tools/support/interrupt.hpp"

#include <time.h>
#include <unistd.h>

#include <csignal>
#include <string_view>

namespace cradle::tools {

namespace {

// Signal handlers may use only global, lock-free variables.
std::atomic<Interrupt*> noting = nullptr;
std::atomic<long> first_at = 0;  // milliseconds; 0: none yet
std::atomic<long> same = 0;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<long>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free && std::atomic<Interrupt*>::is_always_lock_free);

constexpr int noted[] = {SIGINT, SIGTERM, SIGUSR1, SIGHUP};

long milliseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

// Uses only functions that a signal handler may call.
[[noreturn]] void end_at_once(int signal, std::string_view message) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
  ::_exit(static_cast<int>(status_of_signal(signal)));
}

void note(int signal) {
  Interrupt& interrupt = *noting;
  if (!interrupt.heeded()) end_at_once(signal, "cradle: interrupted before there was anything to keep\n");
  const long now = milliseconds();
  if (first_at == 0) {
    first_at = now;
    if (interrupt.signal() == 0) interrupt.note(signal);
    return;
  }
  if (now - first_at > same) end_at_once(signal, "cradle: interrupted again: what was not written yet is lost\n");
}

}  // namespace

Exit status_of_signal(int signal) { return signal == SIGINT ? Exit::interrupted : Exit::terminated; }

void note_signals(Interrupt& interrupt, long same_milliseconds) {
  noting = &interrupt;
  first_at = 0;
  same = same_milliseconds;
  for (const int signal : noted) {
    const auto before = std::signal(signal, signal == SIGHUP && hang_ups_ignored ? SIG_IGN : note);
    if (signal == SIGHUP && before == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // where it is not read earlier
  }
}

void ignore_signals() {
  for (const int signal : noted) std::signal(signal, SIG_IGN);
}

}  // namespace cradle::tools
