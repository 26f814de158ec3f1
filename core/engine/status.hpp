#pragma once
// What a run requires and reports: how it ended, how many collisions it made, a collision as observers receive it, and
// what the caller wants called during the run.

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

enum class Status {
  reached,     // all collisions up to the requested time are made
  collapsed,   // policy stop: inelastic collapse, or a gap below the one given; see collapse()
  exhausted,   // a gap is about to underflow, or time stands still: the scalar type resolves no more
  interrupted  // the caller's `interrupt` said so
};

struct Counts {
  std::uint64_t collisions = 0;  // all of them: those below the cut-off and merges included
  std::uint64_t below_cutoff = 0;
  std::uint64_t merges = 0;
  std::uint64_t close_calls = 0;  // collisions in the plain loop whose key was too close to another one's
  std::uint64_t origin_moves = 0;

  Counts& operator+=(const Counts& other) {
    collisions += other.collisions, below_cutoff += other.below_cutoff, merges += other.merges;
    close_calls += other.close_calls, origin_moves += other.origin_moves;
    return *this;
  }
  static auto state(auto& self) {  // close calls are of how a run was made
    return std::tie(self.collisions, self.below_cutoff, self.merges, self.origin_moves);
  }
};

// A collision as observers receive it, before the law acts.
template <Real T> struct Collision {
  ParticleIndex left, right;  // by their numbers at the start
  Pair<T> time;
  T interval;  // since the collision before it, or the start: resolves what differences of times cannot
  T closing_speed;
};

template <Real T> struct Policy {
  CollapsePolicy collapse = CollapsePolicy::cutoff;
  T stop_gap{0};  // policy stop: continue until a gap is below this; 0: until the collapse time is settled
  // Called after a collision now and then. What they throw leaves `advance`; the run is as it would be without, and can
  // continue.
  std::function<bool()> interrupt = {};  // true ends the run there
  std::function<void(const T& time, const Counts&)> progress = {};

  // The caller wants a collapse followed, however long it takes.
  bool follows_a_gap() const { return collapse == CollapsePolicy::stop && is_positive(stop_gap); }
  // What a collision beside which this gap is left makes of the run; `settled`: its collapse is, `followed`: for long
  // enough. What leaves the type's range without being settled may yet part.
  Status after(const T& gap, bool settled, bool followed) const {
    const T underflow{std::numeric_limits<T>::min()};  // 0 in exact arithmetic, which knows none
    const bool ends = is_positive(gap) && gap < underflow;
    if (follows_a_gap() ? is_positive(gap) && gap < stop_gap : settled && (followed || ends)) return Status::collapsed;
    return ends ? Status::exhausted : Status::reached;
  }
  Status poll(const T& time, const Counts& counts) const {
    if (progress) progress(time, counts);
    return interrupt && interrupt() ? Status::interrupted : Status::reached;
  }
};

// Throws std::invalid_argument for a time that a run cannot advance to.
template <Real T> void require_ahead(const T& until, const T& last_collision) {
  if (!is_finite(until))
    throw std::invalid_argument("the time to advance to is not finite (found " + in_message(until) +
                                "): give a number");
  if (until < last_collision)
    throw std::invalid_argument("the time to advance to is in the past (found " + in_message(until) +
                                ", the last collision was at " + in_message(last_collision) +
                                "): a run goes forward only");
}

}  // namespace cradle
