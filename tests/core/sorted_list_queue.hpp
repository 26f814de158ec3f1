#pragma once
// The event queue in its plainest form, the slow twin of EventQueue: a list sorted by (time, slot), with exact times.

#include <set>
#include <utility>
#include <vector>

#include "cradle/core/queue/event_queue.hpp"

namespace cradle::test {

class SortedListQueue {
 public:
  explicit SortedListQueue(std::size_t slots) : times_(slots, EventQueue::never) {
    for (Slot s = 0; s < slots; ++s) sorted_.emplace(EventQueue::never, s);
  }

  void set(Slot s, double time) {
    sorted_.erase({times_[s], s});
    times_[s] = time;
    sorted_.emplace(time, s);
  }
  Slot next() const { return sorted_.begin()->second; }
  double time(Slot s) const { return times_[s]; }
  std::vector<Slot> before(double time) const {  // at times <= time, from left to right
    std::set<Slot> slots;
    for (auto entry = sorted_.begin(); entry != sorted_.end() && entry->first <= time; ++entry)
      slots.insert(entry->second);
    return {slots.begin(), slots.end()};
  }

 private:
  std::vector<double> times_;
  std::set<std::pair<double, Slot>> sorted_;
};

}  // namespace cradle::test
