#pragma once
// The gaps that a chain in gaps and closing speeds holds (gap_chain.hpp), with the masses between them, the walls, and
// the two anchors that end the active zone: slots, and what each gap is at a time.

#include <initializer_list>
#include <optional>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/gap_line.hpp"
#include "cradle/core/chains/held_range.hpp"
#include "cradle/core/chains/wall_gaps.hpp"

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
  static auto state(auto& self) { return fields(self.last_, self.never_); }

 private:
  std::vector<T> last_;  // local times
  T never_{0};           // marks a gap without a collision
};

template <Real T, class Masses> class HeldGaps : public HeldLine<T, GapLine<T, Masses>> {
  using Held = HeldLine<T, GapLine<T, Masses>>;

 public:
  using Held::first, Held::keys_are_exact, Held::last, Held::on_ring, Held::slots;
  using typename Held::Line;
  static constexpr bool may_collapse = true;

  Slot left(Slot s) const { return on_ring() && s == first() ? last() : s - 1; }
  Slot right(Slot s) const { return on_ring() && s == last() ? first() : s + 1; }
  ParticleIndex particle(Slot s) const { return line_.particle(s); }
  ParticleIndex collided_particles() const {
    if (on_ring()) return particles_->count();
    return range_.has_fronts() ? front_particle(End::right) - front_particle(End::left) + 1 : 0;
  }

  T due(Slot s) const { return wall_gaps_.due(line_, s); }
  double queue_due(Slot s) const { return wall_gaps_.queue_due(line_, s); }
  // The closing speed at the gap's local time.
  const T& closing(Slot s) const { return line_.closing(s); }
  // The closing speed at another time.
  T closing_at(Slot s, const T& time) const {
    if (wall_gaps_.pulls(particle(s))) return wall_gaps_.closing_at(line_, s, time);
    return closing(s);
  }
  // The closing speed at the next collision.
  T closing_when_due(Slot s) const { return wall_gaps_.closing_when_due(line_, s); }

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
  const WallGaps<Line>& wall_gaps() const { return wall_gaps_; }
  ParticleIndex place(Slot s) const { return particle(s); }  // in the order of the line, for any numbering of slots
  bool cramped(std::size_t particles) const { return range_.cramped(slots(), static_cast<ParticleIndex>(particles)); }

 protected:
  using Held::line_, Held::particles_, Held::range_;

  HeldGaps(const std::shared_ptr<const Particles<T>>& particles, const T& start, GapRange held,
           typename Line::Gaps::Memory memory)
      : Held(particles, start, Line(*particles, start, std::move(memory)),
             {particles->on_ring(), held.first - particles->gaps().first, particles->gaps().last - held.last, 2}),
        walls_(particles->walls()), wall_gaps_(*particles) {
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

  CollisionMemory<T> memory_;
  mutable std::optional<T> centre_;  // on a ring: centre of mass at the start, computed when it is first needed
  T fastest_{0};                     // closing speed at the start
  Anchor<T> left_, right_;
  Walls<T> walls_;
  WallGaps<Line> wall_gaps_;
};

}  // namespace cradle
