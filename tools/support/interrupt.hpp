// Signals end a run at the next opportunity, and its results so far are kept. Code that computes gets an Interrupt and
// polls it; only a command connects one with the signals of the process.
#pragma once

#include <atomic>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

class Interrupt {
 public:
  /// Says that somebody polls from now on, and has something to keep.
  void heed() { heeded_ = true; }
  bool heeded() const { return heeded_; }

  /// Notes a signal, here or at another process of the same job. May be called from any thread.
  void note(int signal) { signal_ = signal; }
  /// The signal that has arrived, or 0. May be called from any thread.
  int signal() const { return signal_; }

 private:
  std::atomic<int> signal_ = 0;
  std::atomic<bool> heeded_ = false;
};

/// Whether the program was started under nohup: before_main.cpp, a part of the program alone, reads it.
inline bool hang_ups_ignored = false;

/// The exit status of a program that this signal has interrupted.
Exit status_of_signal(int signal);

/// Notes SIGINT, SIGTERM, SIGUSR1 and SIGHUP in `interrupt` until the program ends. If nobody heeds them yet, or after
/// a second signal, the program ends at once. SIGHUP stays ignored under nohup. Launchers, `timeout` and closing
/// terminals send one signal in two ways: two signals within `same_milliseconds` count as one.
void note_signals(Interrupt& interrupt, long same_milliseconds = 200);

/// Ignores these signals from now on: the program is about to end by itself, and the error has been reported.
void ignore_signals();

}  // namespace cradle::tools
