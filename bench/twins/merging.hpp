#pragma once
// The conventional engine for particles that merge or pass through each other: absolute positions and velocities in
// double, links to the neighbours still there, an indexed heap of the times when gaps close. Every particle of the
// scene is held from the start. On a line or a ring.

#include "indexed_heap.hpp"

namespace twins {

class MergingEngine {
 public:
  // Wet with this loss; below 0: sticky.
  MergingEngine(const cradle::Particles<double>& particles, double loss);

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }
  std::uint64_t merges() const { return merges_; }

 private:
  struct Particle {
    double x, v, m, time;  // x is the position at `time`
    std::uint32_t left, right;
  };

  double due(std::uint32_t i, double now) const;
  void fly(Particle& particle, double time) const;

  double loss_, circumference_;
  std::vector<Particle> particles_;
  IndexedHeap heap_;
  std::uint64_t collisions_ = 0, merges_ = 0;
};

}  // namespace twins
