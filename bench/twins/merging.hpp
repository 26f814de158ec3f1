#pragma once
// The conventional engine for particles that merge or pass through each other, on a line or a ring: absolute positions
// and velocities in double, links between the remaining neighbours, an indexed heap of the times when gaps close. It
// holds every particle of the scene from the start.

#include "queues.hpp"

namespace twins {

class MergingEngine {
 public:
  // `loss`: of the wet law; sticky particles if negative.
  MergingEngine(const cradle::Particles<double>& particles, double loss);

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  struct Particle : Flying {
    double m;
    std::uint32_t left, right;
  };

  double due(std::uint32_t i, double now) const;

  double loss_, circumference_;
  std::vector<Particle> particles_;
  IndexedHeap heap_;
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
