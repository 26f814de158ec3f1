#pragma once
// The gaps that a chain in gaps and closing speeds holds (gap_chain.hpp), with the masses between them, the walls, and
// the two anchors that end the active zone: times, slots, and what each gap is at a time. What is asked of any chain is
// explained in chain.hpp.

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/gap_line.hpp"
#include "cradle/core/chains/held_range.hpp"
#include "cradle/core/chains/wall_gaps.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// The time of the last collision at each gap, for laws with a memory (LawWithMemory); empty for others.
template <Real T> class CollisionMemory {
 public:
  // Whether the last collisions at all these gaps were `span` or longer ago. Records the present collision at the gap
  // s. `start` is the local time at which the run began, `slots` the largest number of gaps.
  bool rested(std::initializer_list<Slot> gaps, Slot s, const T& now, const T& span, const T& start,
              std::size_t slots) {
    if (last_.empty()) {
      never_ = start - span - T(1);
      last_.assign(slots, never_);
    }
    bool all = true;
    for (const Slot gap : gaps) all = all && !(now - last_[gap] < span);
    last_[s] = now;
    return all;
  }

  void lay_out(std::size_t slots, Slot first, const std::vector<Slot>& kept) {
    if (last_.empty()) return;
    std::vector<T> last(slots, never_);
    for (const Slot s : kept) last[first++] = std::move(last_[s]);
    last_ = std::move(last);
  }
  void move_origin(const T& by) {
    for (T& time : last_) time -= by;
    never_ -= by;
  }
  std::size_t slots() const { return last_.size(); }  // 0: nothing is recorded yet
  static auto state(auto& self) { return std::tie(self.last_, self.never_); }

 private:
  std::vector<T> last_;  // local times
  T never_{0};           // marks a gap without a collision
};

template <Real T, class Masses> class HeldGaps {
 public:
  using Scalar = T;
  using Line = GapLine<T, Masses>;
  static constexpr bool may_collapse = true;
  static constexpr bool keys_are_exact = Line::Gaps::keys_are_exact;

  // ---- times: local ones are offsets from an origin that moves
  const Clock<T>& clock() const { return line_.gaps.clock(); }
  const T& start() const { return clock().start(); }
  T local_time(const T& time) const { return clock().offset(time); }
  Pair<T> stamp(const T& local) const { return clock().stamp(local); }
  double queue_time(const T& local) const { return line_.gaps.queue_time(local); }

  // ---- slots: the gaps held are first() to last()
  std::size_t slots() const { return line_.gaps.slots(); }
  Slot first() const { return range_.first(); }
  Slot last() const { return range_.last(); }
  Slot left(Slot s) const { return on_ring() && s == first() ? last() : s - 1; }
  Slot right(Slot s) const { return on_ring() && s == last() ? first() : s + 1; }
  bool on_ring() const { return range_.on_ring(); }
  ParticleIndex particle(Slot s) const { return line_.particle(s); }
  ParticleIndex count() const { return particles_->count(); }
  ParticleIndex collided_particles() const {
    if (on_ring()) return particles_->count();
    return range_.has_fronts() ? front_particle(End::right) - front_particle(End::left) + 1 : 0;
  }

  T due(Slot s) const {
    if constexpr (!keys_are_exact)
      if (wall_gaps_.pulls(particle(s))) return wall_gaps_.due(line_, s).value_or(far_away<T>());
    return line_.due(s);
  }
  double queue_due(Slot s) const {
    if constexpr (!keys_are_exact)
      if (wall_gaps_.pulls(particle(s))) return wall_gaps_.queue_due(line_, s);
    return line_.queue_due(s);
  }
  // The closing speed at the gap's local time.
  const T& closing(Slot s) const { return line_.closing(s); }
  // The closing speed at another time.
  T closing_at(Slot s, const T& time) const {
    if (wall_gaps_.pulls(particle(s))) return wall_gaps_.closing_at(line_, s, time);
    return closing(s);
  }
  // The closing speed at the next collision.
  T closing_when_due(Slot s) const {
    if (!wall_gaps_.pulls(particle(s))) return closing(s);
    const auto meeting = wall_gaps_.meeting(line_, s);
    return meeting ? meeting->speed : T(0);
  }

  void set_floor(const T& floor) { line_.gaps.set_floor(floor); }
  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const T on_left = on_ring() || s > first() ? line_.gaps[left(s)].gap : far,
            on_right = on_ring() || s < last() ? line_.gaps[right(s)].gap : far;
    return on_left < on_right ? on_left : on_right;
  }
  // Whether anything falls or is shaken.
  bool falls() const { return wall_gaps_.anywhere(); }
  std::optional<Rebound<T>> rebound(Slot s) const {
    return wall_gaps_.rebound(particle(s), closing(s), line_.gaps.since_start(s));
  }
  const Account<T>& account() const { return line_.gaps.account(); }
  void lose(Slot s, const T& energy) { line_.gaps.lose(s, energy); }
  T energy_lost() const { return line_.gaps.energy_lost(first(), last()); }
  T time_resolution(Slot, const T& time) const { return line_.gaps.time_resolution(time); }

  // The outcome of a collision at the speed 1, if all outcomes are proportional to the speed.
  template <class Law> std::optional<Outcome<T>> at_unit_speed(const Law& law, Slot s) const {
    if (walls_.beside(particle(s)))
      return walls_.at_unit_speed(particle(s), line_.masses[walls_.left_of(particle(s)) ? s + 1 : s]);
    return law(T(1), line_.masses.of_pair(s));
  }

  // ---- reading, at a local time not before the last collision
  T gap_at(Slot s, const T& time) const {
    if (wall_gaps_.pulls(particle(s))) return wall_gaps_.gap_at(line_, s, time);
    return line_.gaps.gap_at(s, closing(s), time);
  }
  const Walls<T>& walls() const { return walls_; }

  // ---- for segments (segments.hpp)
  const Particles<T>& particles() const { return *particles_; }
  const Line& line() const { return line_; }
  const WallGaps<Line>& wall_gaps() const { return wall_gaps_; }
  void lose(const Ledger<T>& elsewhere) { line_.gaps.lose(elsewhere); }
  ParticleIndex place(Slot s) const { return particle(s); }  // in the order of the line, for any numbering of slots
  // Slots free for particles that the fronts reach.
  std::size_t within_reach_left() const { return range_.free_left(); }
  std::size_t within_reach_right() const { return range_.free_right(slots()); }
  bool cramped(std::size_t particles) const { return range_.cramped(slots(), static_cast<ParticleIndex>(particles)); }
  bool fronts_are_within(Slot left, Slot right) const {
    return on_ring() || (range_.has_fronts() && range_.front_left() <= left && range_.front_right() >= right);
  }
  Slot front_slot_left() const { return range_.front_left(); }
  Slot front_slot_right() const { return range_.front_right(); }

 protected:
  HeldGaps(std::shared_ptr<const Particles<T>> particles, const T& start, GapRange held,
           typename Line::Gaps::Memory memory)
      : particles_(std::move(particles)), line_(*particles_, start, std::move(memory)),
        range_(particles_->on_ring(), held.first - particles_->gaps().first, particles_->gaps().last - held.last, 2),
        walls_(particles_->walls()), wall_gaps_(*particles_) {
    require_particles(*particles_, start);
    if (std::numeric_limits<T>::is_exact) require_no_gravity(*particles_, "use a type that has square roots");
  }

  // The slot of the gap right of a particle.
  Slot slot(ParticleIndex particle) const { return static_cast<Slot>(particle - line_.particle_of_slot_0); }
  // The outermost particle that has collided; walls are not counted.
  ParticleIndex front_particle(End end) const {
    return end == End::left ? std::max<ParticleIndex>(particle(range_.front_left()), 0)
                            : std::min(particle(range_.front_right()) + 1, particles_->count() - 1);
  }
  // The slot of the gap that has so many particles between itself and the wall of the pile.
  Slot slot_in_pile(ParticleIndex height) const {
    const auto h = static_cast<Slot>(height);
    return wall_gaps_.pile_end() == End::left ? first() + h : last() - h;
  }

  std::shared_ptr<const Particles<T>> particles_;
  Line line_;
  HeldRange range_;
  CollisionMemory<T> memory_;
  mutable std::optional<T> centre_;  // on a ring: centre of mass at the start, computed when it is first needed
  T fastest_{0};                     // closing speed at the start
  Anchor<T> left_, right_;
  Walls<T> walls_;
  WallGaps<Line> wall_gaps_;
};

}  // namespace cradle
