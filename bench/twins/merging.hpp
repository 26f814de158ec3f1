#pragma once
// The conventional engine for bodies that merge or pass through each other: absolute positions and velocities in
// double, links to the neighbours still there, an indexed heap of the times when gaps close. Every body of the scene is
// held from the start. On a line or a ring.

#include "indexed_heap.hpp"

namespace twins {

class MergingEngine {
 public:
  // Wet with this loss; below 0: sticky.
  MergingEngine(const cradle::Bodies<double>& bodies, double loss);

  // Makes every contact at times <= until.
  void advance(double until);

  std::uint64_t contacts() const { return contacts_; }
  std::uint64_t merges() const { return merges_; }

 private:
  struct Body {
    double x, v, m, time;  // x is the position at `time`
    std::uint32_t left, right;
  };

  double due(std::uint32_t i, double now) const;
  void fly(Body& body, double time) const;

  double loss_, circumference_;
  std::vector<Body> bodies_;
  IndexedHeap heap_;
  std::uint64_t contacts_ = 0, merges_ = 0;
};

}  // namespace twins
