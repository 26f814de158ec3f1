#pragma once
// A faster form of indexed_heap.hpp: entries contain their times, so that comparing two needs no look-up, and an entry
// that moves up or down leaves a hole instead of being exchanged at every level.

#include <algorithm>

#include "line.hpp"

namespace twins {

class TunedHeapEngine {
 public:
  TunedHeapEngine(const cradle::Particles<double>& particles, Law law)
      : line_(particles, law), heap_(line_.gaps()), place_(line_.gaps()) {
    for (std::uint32_t i = 0; i < heap_.size(); ++i) heap_[i] = {line_.due(i, 0), i};
    std::make_heap(heap_.begin(), heap_.end(), [](const Event& a, const Event& b) { return a.time > b.time; });
    for (std::uint32_t p = 0; p < heap_.size(); ++p) place_[heap_[p].gap] = p;
  }

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  struct Event {
    double time;
    std::uint32_t gap;
  };

  void update(std::uint32_t gap, double time) {
    const std::uint32_t p = place_[gap];
    if (time < heap_[p].time)
      rise(p, {time, gap});
    else
      sink(p, {time, gap});
  }

  void rise(std::uint32_t p, Event event) {
    while (p > 0 && event.time < heap_[(p - 1) / 2].time) {
      put(p, heap_[(p - 1) / 2]);
      p = (p - 1) / 2;
    }
    put(p, event);
  }

  void sink(std::uint32_t p, Event event) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t child; (child = 2 * p + 1) < size; p = child) {
      if (child + 1 < size && heap_[child + 1].time < heap_[child].time) ++child;
      if (!(heap_[child].time < event.time)) break;
      put(p, heap_[child]);
    }
    put(p, event);
  }

  void put(std::uint32_t p, const Event& event) {
    heap_[p] = event;
    place_[event.gap] = p;
  }

  Line line_;
  std::vector<Event> heap_;
  std::vector<std::uint32_t> place_;  // of each gap's entry in the heap
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
