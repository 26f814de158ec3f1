#pragma once
// The textbook event-driven engine: predicted collisions are put into a std::priority_queue and stay there. A collision
// invalidates the predictions for its particles. Such stale events are recognised by the numbers of collisions that the
// two particles had at the time of the prediction, and are skipped when they come to the top.

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
  std::vector<std::uint32_t> had_;  // collisions of each particle until now
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
