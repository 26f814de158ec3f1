#pragma once
// The settings and reports of a run: how it ended, how many collisions it made, a collision as observers receive it,
// and the functions of the caller that are called during the run.

#include <cstdint>
#include <functional>
#include <limits>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/engine/collapse.hpp"

namespace cradle {

enum class Status {
  reached,     // all collisions up to the requested time are made
  collapsed,   // policy stop: inelastic collapse, or a gap below the given one; see collapse()
  exhausted,   // a gap or a rebound is about to underflow, or time does not advance: the scalar type resolves no more
  interrupted  // the caller's `interrupt` returned true
};

struct Counts {
  std::uint64_t collisions = 0;  // all: those below the cut-off and merges included
  std::uint64_t below_cutoff = 0;
  std::uint64_t merges = 0;
  std::uint64_t close_calls = 0;  // collisions of the plain loop with a key too close to another one's
  std::uint64_t origin_moves = 0;

  Counts& operator+=(const Counts& other) {
    collisions += other.collisions, below_cutoff += other.below_cutoff, merges += other.merges;
    close_calls += other.close_calls, origin_moves += other.origin_moves;
    return *this;
  }
  static auto state(auto& self) {  // close calls depend on how a run was computed
    return fields(self.collisions, self.below_cutoff, self.merges, self.origin_moves);
  }
};

// A collision as observers receive it, before the law acts.
template <Real T> struct Collision {
  ParticleIndex left, right;  // by their numbers at the start
  Pair<T> time;
  T interval;  // since the previous collision, or the start: more precise than a difference of times
  T closing_speed;
};

template <Real T> struct Policy {
  CollapsePolicy collapse = CollapsePolicy::cutoff;
  T stop_gap{0};  // policy stop: continue until a gap, or a rebound, is smaller; 0: until the collapse time is known
  // Called after some of the collisions. Exceptions from them leave `advance`; the run is unchanged and can continue.
  std::function<bool()> interrupt = {};  // true ends the run
  std::function<void(const T& time, const Counts&)> progress = {};

  // Whether a gap size is given: then a collapse is followed until a gap is smaller.
  bool follows_a_gap() const { return collapse == CollapsePolicy::stop && is_positive(stop_gap); }
  // By what factor gaps shrink until the run stops at that size.
  template <class Chain> T followed(const Chain& chain) const {
    if (!follows_a_gap() || chain.last() < chain.first()) return T(1);
    const T factor = smallest_gap(chain) / stop_gap;
    return T(1) < factor ? factor : T(1);
  }
  // The status of the run after a collision that leaves this gap beside it, or this rebound from a floor. `settled`
  // says that its collapse is known, `followed` that it was followed for long enough. If a gap leaves the type's range
  // without a settled collapse, the particles may still separate. The height of a rebound leaves it long before the
  // speed does.
  Status after(const T& gap, const std::optional<Rebound<T>>& back, bool settled, bool followed) const {
    const T underflow{std::numeric_limits<T>::min()};  // 0 in exact arithmetic, which knows none
    const auto below = [&](const T& size) { return is_positive(gap) && gap < size; };
    const bool ends = below(underflow) || (back && back->speed < underflow);
    if (follows_a_gap() ? below(stop_gap) || (back && back->height < stop_gap) : settled && (followed || ends))
      return Status::collapsed;
    return ends ? Status::exhausted : Status::reached;
  }
  Status poll(const T& time, const Counts& counts) const {
    if (progress) progress(time, counts);
    return interrupt && interrupt() ? Status::interrupted : Status::reached;
  }
};

// Throws std::invalid_argument for a time that a run cannot advance to.
template <Real T> void require_ahead(const T& until, const T& last_collision) {
  require(is_finite(until), "the time to advance to is not finite (found ", until, "): give a number");
  require(!(until < last_collision), "the time to advance to is in the past (found ", until,
          ", the last collision was at ", last_collision, "): a run goes forward only");
}

}  // namespace cradle
