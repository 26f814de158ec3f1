#pragma once
// The line of cells of a chain in gaps and particle velocities, and the effect of a collision on it. The chain
// (cluster_chain.hpp) or a segment, which is a copy of a part (cluster_segment.hpp), handles its ends.
//
// A cell holds a particle and the gap between it and the next one (timed_gaps.hpp); README.md (ClusterChain) says what
// becomes of cells where particles merge or pass. When two merge, the result stays in the left one's cell, and the
// right one's is vacant until the chain is laid out anew.

#include <concepts>
#include <utility>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/chains/timed_gaps.hpp"
#include "cradle/core/laws/law.hpp"

namespace cradle {

// In double a line of the cache.
template <Real T> struct alignas(std::same_as<T, double> ? 64 : alignof(T)) Cell : TimedGap<T> {
  T velocity{0}, mass{1};
  ParticleIndex particle = 0;  // names the cluster; of two that merge the heavier one's stays
  Slot left = 0, right = 0;

  static auto state(auto& self) {
    return fields(TimedGap<T>::state(self), self.velocity, self.mass, self.left, self.right, self.particle);
  }
};

template <Real T> class ClusterLine {
 public:
  using Gaps = TimedGaps<T, Cell<T>>;

  // `runaway`: twice the largest possible speed or more.
  ClusterLine(const T& start, const T& energy, const T& runaway) : gaps(start, energy), runaway_(runaway) {}

  // Like another one, without any cells yet.
  ClusterLine(const ClusterLine& other, std::size_t slots)
      : gaps(other.gaps.clock().start(), T(1)), runaway_(other.runaway_) {
    gaps.resemble(other.gaps, slots);
  }

  Gaps gaps;
  static auto state(auto& self) { return fields(self.gaps); }

  // ---- slots; a vacant one is linked to itself
  Slot left(Slot s) const { return gaps[s].left; }
  Slot right(Slot s) const { return gaps[s].right; }
  bool vacant(Slot s) const { return gaps[s].right == s; }
  void link(Slot s, Slot next) {
    gaps[s].right = next;
    gaps[next].left = s;
  }
  // A cell beyond the held particles, which moves away faster than any particle can. (If it is inlined, g++ 12 warns of
  // a slot -1.)
  [[gnu::noinline]] void place_end(Slot s, Slot beside) {
    const bool on_left = s < beside;
    gaps.put(s, {{}, on_left ? T(-runaway_) : runaway_, T(1), 0, on_left ? s : beside, on_left ? beside : s});
    (on_left ? gaps[beside].left : gaps[beside].right) = s;
  }
  // Whether the data can be those of a particle and the gap behind it (for the last one of a line a gap that never
  // closes), with receding cells beyond both ends.
  bool fits(Slot s, bool last) const {
    const T speed = magnitude(gaps[s].velocity);
    return speed + speed <= runaway_ && gaps[s].fits(closing(s)) && (last || is_finite(gaps.lag(s)));
  }
  bool ends_beside(Slot first, Slot last) const {
    const Slot p = left(first), n = right(last);
    return p < first && right(p) == first && gaps[p].velocity == -runaway_ && n > last && gaps[n].velocity == runaway_;
  }

  T closing(Slot s) const { return gaps[s].velocity - gaps[gaps[s].right].velocity; }
  TwoMasses<T> masses(Slot s) const { return {gaps[s].mass, gaps[gaps[s].right].mass}; }
  T due(Slot s) const { return gaps.due(s, closing(s)); }
  double queue_due(Slot s) const { return vacant(s) ? EventQueue::never : gaps.queue_due(s, closing(s)); }

  // The effect of a collision at the gap of a cell on it and on its neighbours. (Inlined by force, see gap_line.hpp.)
  [[gnu::always_inline]] CollisionResult<T> strike(Slot s, const T& time, const Outcome<T>& outcome, Notice notice) {
    Cell<T>& l = gaps[s];
    const Slot p = l.left, n = l.right;
    Cell<T>& r = gaps[n];
    const T since = gaps.flown(s, time);
    notice |= of_flight(gaps.queue_time(since), gaps.queue_time(time));
    const T closing_left = closing(p), closing_right = closing(n);
    const T before_left = l.velocity, before_right = r.velocity;
    const T slowed = before_left - outcome.to_left, sped = before_right + outcome.to_right;
    Slot beyond = n;
    if (outcome.event == Event::merge) {
      absorb_right(s, l.mass < r.mass ? sped : slowed);  // the heavier one's velocity hardly changes
      beyond = s;
    } else {
      gaps.close(s, outcome.closing, since, time);
      const bool pass = outcome.event == Event::pass;
      l.velocity = pass ? sped : slowed;
      r.velocity = pass ? slowed : sped;
      if (outcome.closing == T(0) && !pass) [[unlikely]]  // they move together, which rounding must not undo
        l.velocity = r.velocity = l.mass < r.mass ? sped : slowed;
      if (pass) {
        std::swap(l.mass, r.mass);
        std::swap(l.particle, r.particle);
      }
    }
    notice |= kick(p, closing_left, before_left, l.velocity, since, time);
    notice |= kick(beyond, closing_right, gaps[beyond].velocity, before_right, since, time);
    return {outcome, predict(p), predict(s), beyond == n ? predict(n) : EventQueue::never, notice, p, n};
  }

 private:
  // Merges the particles at s and right of it into the cell s.
  void absorb_right(Slot s, const T& velocity) {
    Cell<T>& l = gaps[s];
    const Slot n = l.right;
    Cell<T>& r = gaps[n];
    if (l.mass < r.mass) l.particle = r.particle;
    l.velocity = velocity;
    l.mass += r.mass;
    gaps.carry(n, s);
    gaps.forget(n);
    link(s, r.right);
    r.right = n;
  }

  // Updates a gap beside a collision: it closes faster by the excess of u_left over u_right. `struck` is the time since
  // the local time of the gap of the collision.
  [[gnu::always_inline]] Notice kick(Slot s, const T& so_far, const T& u_left, const T& u_right, const T& struck,
                                     const T& time) {
    const T since = gaps.kick(
        s, so_far, [&] { return T(u_left - u_right); }, time);
    if (gaps.below_floor(s)) [[unlikely]]
      return gaps.note(s, closing(s), T(u_left - u_right), since, struck, gaps[s].particle, time);
    return Notice::none;
  }
  [[gnu::always_inline]] double predict(Slot s) { return gaps.predict(s, closing(s)); }

  T runaway_;
};

}  // namespace cradle
