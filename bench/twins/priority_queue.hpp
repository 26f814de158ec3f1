#pragma once
// The textbook event-driven engine: predicted collisions go into a std::priority_queue and stay there. A collision
// changes what was predicted for the particles involved; such stale events are known by the number of collisions that
// the two particles had when they were predicted, and are skipped when they surface.

#include <queue>

#include "line.hpp"

namespace twins {

class PriorityQueueEngine {
 public:
  PriorityQueueEngine(const cradle::Particles<double>& particles, Law law)
      : line_(particles, law), had_(line_.gaps() + 1, 0) {
    for (std::size_t i = 0; i < line_.gaps(); ++i) predict(i, 0);
  }

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  struct Event {
    double time;
    std::uint32_t left, left_had, right_had;
    bool operator>(const Event& other) const { return time > other.time; }
  };

  void predict(std::size_t i, double now) {
    const double due = line_.due(i, now);
    if (due < never) events_.push({due, static_cast<std::uint32_t>(i), had_[i], had_[i + 1]});
  }

  Line line_;
  std::vector<std::uint32_t> had_;  // collisions of each particle so far
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
