#pragma once
// Compares runs: states bit for bit, also of what continues from a saved one, and sequences of collisions if their
// order matters. Collisions at gaps that are not neighbours commute, so two runs made the same collisions if the order
// is the same at every two neighbouring gaps.

#include <gtest/gtest.h>

#include "cradle/core/base/state.hpp"
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

// Two runs of the same particles at a time: the particles, and all that runs count and sum up.
template <class Run, class Other, class T> void expect_same_state(const Run& a, const Other& b, const T& time) {
  EXPECT_TRUE(identical(a.configuration(time), b.configuration(time)));
  EXPECT_TRUE(same_collisions(a.counts(), b.counts())) << a.counts().collisions << ", " << b.counts().collisions;
  EXPECT_EQ(a.counts().origin_moves, b.counts().origin_moves);
  EXPECT_EQ(a.chain().local_time(time), b.chain().local_time(time));
  EXPECT_EQ(a.energy_lost(time), b.energy_lost(time));
  EXPECT_EQ(a.last_collision_time(), b.last_collision_time());
  EXPECT_EQ(a.account().simultaneous, b.account().simultaneous);
  EXPECT_EQ(a.account().order_lost, b.account().order_lost);
  EXPECT_EQ(a.account().first_order_lost.time, b.account().first_order_lost.time);
  EXPECT_EQ(a.collided_particles(), b.collided_particles());
  if constexpr (requires { a.chain().walls(); }) {
    EXPECT_TRUE(SavedState::of(a.chain().walls()) == SavedState::of(b.chain().walls()));
  }
  if (a.on_ring() || a.collided_particles() == 0) return;
  EXPECT_EQ(a.front_left(time), b.front_left(time));
  EXPECT_EQ(a.front_right(time), b.front_right(time));
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

// Of a run up to a time.
template <class Run, class T> Sequence sequence_to(Run& run, const T& time) {
  Sequence sequence;
  EXPECT_EQ(run.advance(time, [&](const Collision<T>& c) { sequence.add(c.left); }), Status::reached);
  return sequence;
}

template <class T> T largest_difference(const std::vector<T>& a, const std::vector<T>& b) {
  EXPECT_EQ(a.size(), b.size());
  T largest(0);
  for (std::size_t j = 0; j < std::min(a.size(), b.size()); ++j) {
    const T difference = magnitude(T(a[j] - b[j]));
    if (!(difference == difference)) return difference;  // not a number
    largest = std::max(largest, difference);
  }
  return largest;
}

// A run or an observer that continues from the state of another one.
template <class X> void restore(X& later, const X& saved) {
  SavedState state = SavedState::of(saved);
  load(state, later);
  EXPECT_EQ(state.left(), 0U);
}

// Saves a run every `step` and continues it with a new run from make(): the bits must be those of the uninterrupted
// run.
template <class Make, class Check>
void expect_same_from_anywhere(const Make& make, double step, double end, const Check& check) {
  for (double cut = 0; cut < end; cut += step) {
    SCOPED_TRACE(cut);
    auto whole = make(), later = make();
    whole.advance(cut);
    restore(later, whole);
    EXPECT_TRUE(SavedState::of(later) == SavedState::of(whole));
    whole.advance(end);
    later.advance(end);
    EXPECT_TRUE(SavedState::of(later) == SavedState::of(whole));
    check(later, whole);
  }
}

// The same of an observer, as it is before the first of so many samples; `add(observer, k)` adds number k. The state of
// the complete one must be refused by all of `others`, which have other sizes.
template <class Observer, class Add>
void expect_continues(Observer whole, std::size_t samples, std::size_t cut, const Add& add,
                      std::initializer_list<Observer> others) {
  Observer later = whole;
  for (std::size_t k = 0; k < samples; ++k) {
    if (k == cut) restore(later, whole);
    add(whole, k);
    if (k >= cut) add(later, k);
  }
  EXPECT_TRUE(SavedState::of(later) == SavedState::of(whole));
  for (Observer other : others) EXPECT_THROW(restore(other, whole), std::invalid_argument);
}

}  // namespace cradle::test
