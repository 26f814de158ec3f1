#pragma once
// Compares runs: states bit for bit, and sequences of collisions if their order matters. Collisions at gaps that are
// not neighbours commute, so two runs made the same collisions if the order is the same at every two neighbouring gaps.

#include <map>
#include <vector>

#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/engine/simulation.hpp"

namespace cradle::test {

template <class T> bool identical(const Configuration<T>& a, const Configuration<T>& b) {
  return a.time == b.time && a.from == b.from && a.to == b.to && a.collided_from == b.collided_from &&
         a.collided_to == b.collided_to && a.index == b.index && a.x == b.x && a.v == b.v && a.m == b.m &&
         a.gap == b.gap && a.closing_speed == b.closing_speed && a.closure_gap == b.closure_gap &&
         a.closure_speed == b.closure_speed;
}

// `close_calls` and `origin_moves` depend on how the run was computed, not on the motion.
inline bool same_collisions(const Counts& a, const Counts& b) {
  return a.collisions == b.collisions && a.below_cutoff == b.below_cutoff && a.merges == b.merges;
}
inline bool identical(const Counts& a, const Counts& b) {
  return same_collisions(a, b) && a.close_calls == b.close_calls && a.origin_moves == b.origin_moves;
}

// The collisions in order, for each gap and its right neighbour.
class Sequence {
 public:
  void add(ParticleIndex left) {
    at_pair_[left].push_back(left);
    at_pair_[left - 1].push_back(left);
  }
  friend bool operator==(const Sequence&, const Sequence&) = default;

 private:
  std::map<ParticleIndex, std::vector<ParticleIndex>> at_pair_;
};

}  // namespace cradle::test
