#include "cradle/tools/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace cradle::tools {

namespace {

volatile std::sig_atomic_t noted = 0;  // what a handler may write to is global

void note(int signal) { noted = signal; }

}  // namespace

void note_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, note);
}

int noted_signal() { return noted; }

}  // namespace cradle::tools
