// Progress of a run on standard error: a bar on a terminal, a plain line now and then elsewhere (where asked for):
// simulated time, contacts, contacts/s, time left.
#pragma once

#include <chrono>
#include <cstdint>

namespace cradle::tools {

class Progress {
 public:
  enum class Show { never, on_terminal, always };

  Progress(Show show, double start, double until);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap to call often: prints at most a few times a second on a terminal, every ten seconds elsewhere.
  void tell(double time, std::uint64_t contacts);

 private:
  using Clock = std::chrono::steady_clock;

  bool active_, terminal_;
  bool drawn_ = false;
  double start_, until_;
  double last_time_;
  std::uint64_t last_contacts_ = 0;
  double speed_ = 0;  // simulated time per second, smoothed
  Clock::time_point last_ = Clock::now();
};

}  // namespace cradle::tools
