// Progress on standard error: a bar on a terminal, a plain line now and then elsewhere (where requested). Of a run:
// simulated time, collisions, collisions/s, time left; of an ensemble: replicas, replicas/s, time left. For programs
// that call this one: where CRADLE_PROGRESS_FD names a socket, each line goes there as `SHARE<tab>TEXT`, SHARE from 0
// to 1.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace cradle::tools {

/// "6 s", "3 min 20 s", "2 h 05 min".
std::string duration(double seconds);

/// One line, drawn over itself on a terminal and gone at the end.
class ProgressLine {
 public:
  enum class Show { never, on_terminal, always };

  explicit ProgressLine(Show show);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Seconds since the line was last drawn, where it is time to draw it again: a few times a second on a terminal,
  /// every ten seconds elsewhere. Cheap to call often.
  std::optional<double> due() const;
  void draw(double share, const std::string& state);

 private:
  using Clock = std::chrono::steady_clock;

  int socket_;  // below 0: none
  bool terminal_, active_, drawn_ = false;
  Clock::time_point last_ = Clock::now();
};

class Progress {
 public:
  using Show = ProgressLine::Show;

  Progress(Show show, double start, double until);

  /// The run has been there already.
  void continue_from(double time, std::uint64_t collisions) { last_time_ = time, last_collisions_ = collisions; }
  /// Cheap to call often: prints at most a few times a second on a terminal, every ten seconds elsewhere.
  void report(double time, std::uint64_t collisions);

 private:
  ProgressLine line_;
  double start_, until_;
  double last_time_;
  std::uint64_t last_collisions_ = 0;
  double speed_ = 0;  // simulated time per second, smoothed
};

class ReplicaProgress {
 public:
  /// Of `total` replicas, `before` were there already.
  ReplicaProgress(ProgressLine::Show show, std::uint64_t before, std::uint64_t total);

  /// So many more are done; may be called from several threads.
  void done(std::uint64_t replicas = 1);

 private:
  std::mutex mutex_;
  ProgressLine line_;
  std::uint64_t before_, done_, total_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace cradle::tools
