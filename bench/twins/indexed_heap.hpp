#pragma once
// The better conventional engine: a binary heap with one entry per gap. It knows the place of each gap's entry, so a
// new prediction replaces the old one in place (increase or decrease key). There are no stale events, and the heap
// never grows. The layout is that of textbooks: gaps in heap order, the place of each gap, the key of each gap.

#include <utility>

#include "line.hpp"

namespace twins {

class IndexedHeap {
 public:
  explicit IndexedHeap(std::vector<double> due) : heap_(due.size()), place_(due.size()), due_(std::move(due)) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t i = 0; i < size; ++i) heap_[i] = place_[i] = i;
    for (std::uint32_t p = size / 2; p-- > 0;) sink(p);
  }

  std::uint32_t first() const { return heap_[0]; }
  double due(std::uint32_t gap) const { return due_[gap]; }

  void update(std::uint32_t gap, double time) {
    const bool sooner = time < due_[gap];
    due_[gap] = time;
    if (sooner)
      rise(place_[gap]);
    else
      sink(place_[gap]);
  }

 private:
  void rise(std::uint32_t p) {
    for (; p > 0 && before(p, (p - 1) / 2); p = (p - 1) / 2) exchange(p, (p - 1) / 2);
  }

  void sink(std::uint32_t p) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t child; (child = 2 * p + 1) < size; p = child) {
      if (child + 1 < size && before(child + 1, child)) ++child;
      if (!before(child, p)) break;
      exchange(p, child);
    }
  }

  bool before(std::uint32_t p, std::uint32_t q) const { return due_[heap_[p]] < due_[heap_[q]]; }
  void exchange(std::uint32_t p, std::uint32_t q) {
    std::swap(heap_[p], heap_[q]);
    place_[heap_[p]] = p;
    place_[heap_[q]] = q;
  }

  std::vector<std::uint32_t> heap_;   // gaps
  std::vector<std::uint32_t> place_;  // of each gap in the heap
  std::vector<double> due_;           // of each gap
};

class IndexedHeapEngine {
 public:
  IndexedHeapEngine(const cradle::Particles<double>& particles, Law law)
      : line_(particles, law), heap_(line_.all_due()) {}

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  Line line_;
  IndexedHeap heap_;
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
