#pragma once
// The textbook event-driven engine: predicted contacts go into a std::priority_queue and stay there. A contact changes
// what was predicted for the bodies involved; such stale events are known by the number of contacts that the two bodies
// had when they were predicted, and are skipped when they surface.

#include <queue>

#include "line.hpp"

namespace twins {

class PriorityQueueEngine {
 public:
  PriorityQueueEngine(const cradle::Bodies<double>& bodies, Law law) : line_(bodies, law), had_(line_.gaps() + 1, 0) {
    for (std::size_t i = 0; i < line_.gaps(); ++i) predict(i, 0);
  }

  // Makes every contact at times <= until.
  void advance(double until);

  std::uint64_t contacts() const { return contacts_; }

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
  std::vector<std::uint32_t> had_;  // contacts of each body so far
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t contacts_ = 0;
};

}  // namespace twins
