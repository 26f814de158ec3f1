#pragma once
// `HeldRange` says how much of a line a chain holds, and how far collisions have spread in it. Rows are streamed
// (README.md). From left to right:
//
//   unheld particles | first ... left front ~~~ collisions ~~~ right front ... last | unheld particles
//
// Slots are those of the chain. They number gaps (the fronts are then the outermost gaps that have had a collision) or
// particles (the outermost particles that have collided). The held range can grow into empty slots on either side;
// `cramped` says when they are used up and the chain must be laid out anew. On a ring all particles are held, and there
// are no fronts.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/clock.hpp"
#include "cradle/core/queue/event_queue.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

class HeldRange {
 public:
  // Where collisions have been made until now.
  enum class Extent { nowhere, between_fronts, ring };
  // What there is next to a front, away from the collisions.
  enum class Beyond { held, row, nothing };

  // `spare`: slots that stay empty at either end.
  HeldRange(bool on_ring, ParticleIndex unheld_left, ParticleIndex unheld_right, Slot spare)
      : extent_(on_ring ? Extent::ring : Extent::nowhere), unheld_left_(unheld_left), unheld_right_(unheld_right),
        spare_(spare) {}

  Slot first() const { return first_; }
  Slot last() const { return last_; }
  ParticleIndex unheld_left() const { return unheld_left_; }
  ParticleIndex unheld_right() const { return unheld_right_; }

  // Puts so many held slots in the middle of enough slots for the held range to grow by `growth` on either side, and
  // returns their number. `kept`: the previous slots of the held ones.
  std::size_t lay_out(std::size_t held, ParticleIndex growth, const std::vector<Slot>& kept = {}) {
    first_ = static_cast<Slot>(std::min(unheld_left_, growth)) + spare_;
    last_ = first_ + held - 1;
    if (has_fronts())
      for (Slot* front : {&front_left_, &front_right_})
        *front = first_ + static_cast<Slot>(std::lower_bound(kept.begin(), kept.end(), *front) - kept.begin());
    return last_ + 1 + static_cast<Slot>(std::min(unheld_right_, growth)) + spare_;
  }
  // Free slots for the next particles of the rows.
  std::size_t free_left() const { return std::min(static_cast<std::size_t>(unheld_left_), first_ - spare_); }
  std::size_t free_right(std::size_t slots) const {
    return std::min(static_cast<std::size_t>(unheld_right_), slots - 1 - spare_ - last_);
  }
  // Whether there are fewer free slots than `particles`, while rows have particles left: by default, whether the next
  // collision at a front might find no slot for the particle that it takes in.
  bool cramped(std::size_t slots, ParticleIndex particles = 1) const {
    return static_cast<ParticleIndex>(free_left()) < std::min(particles, unheld_left_) ||
           static_cast<ParticleIndex>(free_right(slots)) < std::min(particles, unheld_right_);
  }

  // ---- fronts
  bool on_ring() const { return extent_ == Extent::ring; }
  bool has_fronts() const { return extent_ == Extent::between_fronts; }
  Slot front_left() const { return front_left_; }
  Slot front_right() const { return front_right_; }
  // Whether a collision from one slot to the other is between the fronts and touches neither.
  bool inside(Slot left, Slot right) const { return (left > front_left_) & (right < front_right_); }
  // Extends the fronts to a collision from one slot to the other.
  void reach(Slot left, Slot right) {
    if (!has_fronts()) front_left_ = left, front_right_ = right;
    extent_ = Extent::between_fronts;
    front_left_ = std::min(front_left_, left);
    front_right_ = std::max(front_right_, right);
  }
  // On a ring whose slots are gaps: those at either end are next to the seam, and so not `inside`.
  void place_seam() { front_left_ = first_, front_right_ = last_; }

  // ---- of a front
  Beyond beyond_left(Slot s) const { return s != first_ ? Beyond::held : row_or_nothing(unheld_left_); }
  Beyond beyond_right(Slot s) const { return s != last_ ? Beyond::held : row_or_nothing(unheld_right_); }
  // From now on the held slots are those from `first` to `last`.
  void hold(Slot first, Slot last) { first_ = first, last_ = last; }
  // Takes in the next particle of a row, in the slot next to the last held one; returns its number, of `count`
  // particles in all.
  ParticleIndex take_in_left() {
    --first_;
    return --unheld_left_;
  }
  ParticleIndex take_in_right(ParticleIndex count) {
    ++last_;
    return count - unheld_right_--;
  }
  // After a time slab (segments.hpp): so many particles have been taken in on either side; where the fronts are then.
  void take_in(ParticleIndex left, ParticleIndex right) { unheld_left_ -= left, unheld_right_ -= right; }
  void place_fronts(Slot left, Slot right) { front_left_ = left, front_right_ = right; }
  // The particle at `gone` becomes part of the one at `s` on its left; `next` is on its right.
  void merge(Slot s, Slot gone, Slot next) {
    if (last_ == gone) last_ = s;
    if (first_ == gone) first_ = next;
    if (front_right_ == gone) front_right_ = s;
  }

  static auto state(auto& self) {
    return fields(self.extent_, self.first_, self.last_, self.front_left_, self.front_right_, self.unheld_left_,
                  self.unheld_right_);
  }
  // Whether it can be the range of a chain with so many slots. They hold all of the `count` particles but the unheld
  // ones or, after mergers, fewer.
  bool fits(std::size_t slots, ParticleIndex count) const {
    const bool held = last_ < slots && slots - 1 - last_ >= spare_ && first_ >= spare_ && last_ + 1 >= first_;
    const bool fronts = has_fronts() ? first_ <= front_left_ && front_left_ <= front_right_ && front_right_ <= last_
                                     : on_ring() || (front_left_ == 0 && front_right_ == 0);
    return extent_ <= Extent::ring && held && fronts && unheld_left_ >= 0 && unheld_right_ >= 0 &&
           unheld_left_ <= count && unheld_right_ <= count - unheld_left_;
  }

 private:
  static Beyond row_or_nothing(ParticleIndex unheld) { return unheld > 0 ? Beyond::row : Beyond::nothing; }

  Extent extent_;
  Slot first_ = 0, last_ = 0;
  Slot front_left_ = 0, front_right_ = 0;  // both 0 while there are none; then no slot is inside
  ParticleIndex unheld_left_, unheld_right_;
  Slot spare_;
};

// What both chains in gaps are: a line (gap_line.hpp, cluster_line.hpp) of which a range is held. What is asked of any
// chain is explained in chain.hpp.
template <Real T, class OfLine> class HeldLine {
 public:
  using Scalar = T;
  using Line = OfLine;
  static constexpr bool keys_are_exact = Line::Gaps::keys_are_exact;

  // ---- times: local ones are offsets from an origin that moves
  const Clock<T>& clock() const { return line_.gaps.clock(); }
  const T& start() const { return clock().start(); }
  T local_time(const T& time) const { return clock().offset(time); }
  Pair<T> stamp(const T& local) const { return clock().stamp(local); }
  double queue_time(const T& local) const { return line_.gaps.queue_time(local); }
  T time_resolution(Slot, const T& time) const { return line_.gaps.time_resolution(time); }

  std::size_t slots() const { return line_.gaps.slots(); }
  Slot first() const { return range_.first(); }
  Slot last() const { return range_.last(); }
  bool on_ring() const { return range_.on_ring(); }
  ParticleIndex count() const { return particles_->count(); }

  void set_floor(const T& floor) { line_.gaps.set_floor(floor); }
  const Account<T>& account() const { return line_.gaps.account(); }
  void lose(Slot s, const T& energy) { line_.gaps.lose(s, energy); }
  T energy_lost() const { return line_.gaps.energy_lost(first(), last()); }

  // ---- for segments (segments.hpp)
  const Line& line() const { return line_; }
  const HeldRange& range() const { return range_; }
  void lose(const Ledger<T>& elsewhere) { line_.gaps.lose(elsewhere); }
  bool fronts_are_within(Slot left, Slot right) const {
    return on_ring() || (range_.has_fronts() && range_.front_left() <= left && range_.front_right() >= right);
  }

 protected:
  HeldLine(std::shared_ptr<const Particles<T>> particles, const T& start, Line line, const HeldRange& range)
      : particles_(std::move(particles)), line_(std::move(line)), range_(range) {
    require_particles(*particles_, start);
  }

  std::shared_ptr<const Particles<T>> particles_;
  Line line_;
  HeldRange range_;
};

}  // namespace cradle
