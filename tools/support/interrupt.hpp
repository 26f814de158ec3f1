// Signals end a run at the next opportunity, in order, with what it has computed. Whoever computes is handed an
// Interrupt and polls it; only a command connects one with the signals of the process.
#pragma once

#include <atomic>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

class Interrupt {
 public:
  /// From now on somebody polls, and has something to keep.
  void heed() { heeded_ = true; }
  bool heeded() const { return heeded_; }

  /// A signal has arrived, here or at another process of the same job. May be called from any thread.
  void note(int signal) { signal_ = signal; }
  /// The signal that has arrived, or 0. May be called from any thread.
  int signal() const { return signal_; }

 private:
  std::atomic<int> signal_ = 0;
  std::atomic<bool> heeded_ = false;
};

/// With which status a program ends that this signal has interrupted.
Exit status_of_signal(int signal);

/// From now on SIGINT, SIGTERM, SIGUSR1 and SIGHUP are noted there, as long as the program runs. While nobody heeds
/// them, and where a second one comes after the first, the program ends at once. SIGHUP stays ignored under nohup.
/// Launchers, `timeout` and terminals that close send one signal in two ways: within so many milliseconds it is one.
void note_signals(Interrupt& interrupt, long same_milliseconds = 200);

/// From now on they change nothing: the program ends by itself, and what is wrong has been said.
void ignore_signals();

}  // namespace cradle::tools
