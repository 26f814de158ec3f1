// Messages and progress on standard error. Progress is a bar on a terminal, else a plain line every minute or, if
// requested, every ten seconds. For a run: simulated time, collisions, collisions/s, time left where it can be
// predicted; for an ensemble: replicas, replicas/s, time left. For programs that call this one: if CRADLE_PROGRESS_FD
// names a socket, each line is also written there as `SHARE<tab>TEXT`, with SHARE from 0 to 1; and once that program
// has ended, this one is interrupted, as by SIGTERM.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cradle::tools {

/// Prints a message. If nobody can read it (the terminal has closed) work continues.
void notify(std::string_view text);

/// "6 s", "3 min 20 s", "2 h 05 min".
std::string duration(double seconds);

/// How long a run still needs, from its pace so far. What a unit of simulated time costs may grow: in a dry shock it
/// grows linearly until the collapse, and by orders of magnitude there. With c the cost of a unit in the last quarter
/// of the computing and in the quarter before, c is extrapolated linearly to the rest of the run. Nobody can foresee a
/// jump, so an answer is given only while the totals that would have been predicted earlier, at a half and at three
/// quarters of the computing so far, agree with the present one within a factor of 1.5.
class TimeLeft {
 public:
  /// The run has reached this simulated time after so many seconds of computing; both increase.
  void add(double seconds, double time);
  /// Seconds of computing until a simulated time; nothing if they cannot be predicted.
  std::optional<double> until(double end) const;

 private:
  std::vector<std::pair<double, double>> points_;
};

/// One line; on a terminal it is redrawn in place and removed at the end.
class ProgressLine {
 public:
  enum class Show { never, on_terminal, always };

  explicit ProgressLine(Show show);
  ~ProgressLine();
  ProgressLine& operator=(ProgressLine&&) = delete;

  using Clock = std::chrono::steady_clock;

  /// Seconds since the line was last drawn, if it is time to draw it again: a few times a second on a terminal, every
  /// minute elsewhere, or every ten seconds if it is always shown. Cheap to call often.
  std::optional<double> due() const { return active_ ? due(Clock::now()) : std::nullopt; }
  std::optional<double> due(Clock::time_point now) const;
  void draw(double share, const std::string& state);

 private:
  int socket_;  // negative: none
  bool terminal_, active_, drawn_ = false;
  double every_;  // seconds
  Clock::time_point last_ = Clock::now();
};

class Progress {
 public:
  using Show = ProgressLine::Show;

  /// `predictable`: whether the pace so far says how long the rest takes.
  Progress(Show show, double start, double until, bool predictable);

  /// Sets where a resumed run begins.
  void continue_from(double time, std::uint64_t collisions);
  /// Cheap to call often: prints as often as a line is due.
  void report(double time, std::uint64_t collisions);

 private:
  using Clock = ProgressLine::Clock;

  ProgressLine line_;
  double start_, until_;
  bool predictable_;
  std::uint64_t last_collisions_ = 0;
  Clock::time_point started_ = Clock::now();
  TimeLeft left_;
};

class ReplicaProgress {
 public:
  /// `before` of the `total` replicas were there already.
  ReplicaProgress(ProgressLine::Show show, std::uint64_t before, std::uint64_t total);

  /// Counts finished replicas; may be called from several threads.
  void done(std::uint64_t replicas = 1);

 private:
  std::mutex mutex_;
  ProgressLine line_;
  std::uint64_t before_, done_, total_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

}  // namespace cradle::tools
