#pragma once
// The ends of the active zone of a chain in gaps and closing speeds: how the chain takes in the particles that its
// fronts reach, collision by collision or, after a time slab (segments.hpp), all at once; how it makes slots for them;
// and what walls give to particles that rest on them.
//
// While a particle is carried from x, v to x', v' in the time t, the wall gives it the momentum m (v' - v - a t) and
// the energy m (v'^2 - v^2)/2 - m a (x' - x), in no collision. They are entered in the accounts when its gap next
// changes, and added to them when they are read before.

#include "cradle/core/chains/gap_places.hpp"

namespace cradle {

// How the front at one end of a line has moved in a time slab (segments.hpp): the outermost slot with a collision, and
// the collisions at the last gap of the line, with the velocity that each gave to the last particle.
template <Real T> struct FrontMove {
  struct AtEnd {
    T time, handed;
  };
  Slot reached = 0;
  std::vector<AtEnd> at_end;
  WallTally<T> wall;  // of the wall at this end
};

template <Real T, class Masses> class GapEnds : public GapPlaces<T, Masses> {
  using Places = GapPlaces<T, Masses>;

 public:
  using Places::count, Places::closing;
  using Places::falls, Places::clock, Places::slots, Places::first, Places::last, Places::on_ring, Places::particle;
  using typename Places::Line;

  // Replaces the gaps by those after a time slab, in the same slots and in those that the fronts have reached.
  void continue_with(typename Line::Gaps& after, const FrontMove<T>& to_left, const FrontMove<T>& to_right) {
    line_.gaps.swap_gaps(after);
    if (on_ring()) return;
    range_.reach(to_left.reached, to_right.reached);
    while (first() >= range_.front_left() && range_.beyond_left(first()) == HeldRange::Beyond::row) take_in(End::left);
    while (last() <= range_.front_right() && range_.beyond_right(last()) == HeldRange::Beyond::row) take_in(End::right);
    find_inner();
    walls_.continue_with(to_left.wall, to_right.wall);
    const ParticleIndex left = particle(range_.front_left()), right = particle(range_.front_right()) + 1;
    const GapRange all = particles_->gaps();
    if (left > all.first || walls_.has(End::left)) left_.take(std::max(left - 1, all.first));
    if (right < all.last + 1 || walls_.has(End::right)) right_.take(std::min(right + 1, all.last + 1));
    for (const auto& collision : to_left.at_end) follow_end(End::left, left, collision.time, T(-collision.handed));
    for (const auto& collision : to_right.at_end) follow_end(End::right, right, collision.time, collision.handed);
  }

  // The accounts of the walls until a local time, with what they have given to particles that rest on one since.
  Walls<T> walls_at(const T& time) const {
    Walls<T> all = walls_;
    const auto carry = [&](Slot s) {
      const WallImpulse more = carried(s, time);
      all.carry(more.end, more.energy, more.momentum);
    };
    if (wall_gaps_.at_wall(particle(first()))) carry(first());
    if (first() < last() && wall_gaps_.at_wall(particle(last()))) carry(last());
    for (ParticleIndex h = 1; h < wall_gaps_.resting(); ++h) carry(slot_in_pile(h));
    return all;
  }

 protected:
  using Places::Places, Places::line_, Places::range_, Places::particles_, Places::memory_, Places::walls_;
  using Places::wall_gaps_, Places::left_, Places::right_, Places::flight, Places::slot_in_pile;

  // Changes to enough slots for the zone to grow by half on either side, with the gaps at `kept`.
  void lay_out(const std::vector<Slot>& kept, ParticleIndex held) {
    const std::size_t needed = range_.lay_out(static_cast<std::size_t>(held), held / 2 + 8, kept);
    line_.particle_of_slot_0 = particles_->gaps().first + range_.unheld_left() - static_cast<ParticleIndex>(first());
    line_.gaps.lay_out(needed, first(), kept);
    memory_.lay_out(needed, first(), kept);
    line_.masses.resize(needed);
    for (Slot s = first(); s <= last() + 1; ++s) line_.load_mass(s, *particles_);
    find_inner();
  }

  // Whether a collision concerns no end; under gravity, also no wall or pile, nor a gap beside one.
  bool is_inner(Slot s) const { return (s > inner_.after) & (s < inner_.before); }
  void find_inner() {
    inner_ = {range_.front_left(), range_.front_right()};
    if (!falls()) return;
    const auto pile = static_cast<Slot>(wall_gaps_.resting());
    const bool left = wall_gaps_.pile_end() == End::left;
    const Slot margin = left ? 1 : 1 + pile;
    inner_ = {inner_.after + (left ? 1 + pile : 1), inner_.before > margin ? inner_.before - margin : 0};
  }

  // A collision at an end of the active zone: takes in the next particle there or, at an end of the line, follows the
  // last one.
  Notice widen(Slot s, const T& time, const Outcome<T>& outcome) {
    range_.reach(s, s);
    const auto handed = line_.handed(s, outcome);
    if (s == range_.front_left()) widen_at(End::left, s, time, -handed.left, outcome.to_left);
    if (s == range_.front_right()) widen_at(End::right, s, time, handed.right, outcome.to_right);
    find_inner();
    return range_.cramped(slots()) ? Notice::needs_slots : Notice::none;
  }

  // Predicts the next collisions with walls under gravity, where all others have just been.
  void foresee_walls() {
    if (wall_gaps_.at_wall(particle(first()))) wall_gaps_.foresee(line_, first());
    if (first() < last() && wall_gaps_.at_wall(particle(last()))) wall_gaps_.foresee(line_, last());
    if (wall_gaps_.resting() > 0)
      if (const Slot above = slot_in_pile(wall_gaps_.resting()); wall_gaps_.above_pile(particle(above)))
        wall_gaps_.foresee(line_, above);
  }

  // Enters in the accounts what a wall has given until now (see `carried`).
  void enter_carried(Slot s, const T& time) {
    const WallImpulse more = carried(s, time);
    if (more.momentum == T(0)) return;
    walls_.carry(more.end, more.energy, more.momentum);
    line_.gaps.lose(s, T(-more.energy));
  }

 private:
  // `widen` at one end. The collision gives `gain` to the last particle, if it is one of these two, and makes the gap
  // beyond it close faster by `faster`.
  template <class Gain> void widen_at(End end, Slot s, const T& time, const Gain& gain, const T& faster) {
    const bool left = end == End::left;
    const Slot beside = left ? s - 1 : s + 1;
    const HeldRange::Beyond beyond = left ? range_.beyond_left(s) : range_.beyond_right(s);
    if (beyond == HeldRange::Beyond::row) {
      take_in(end);
      line_.load(beside, *particles_, time);
    }
    if (beyond == HeldRange::Beyond::nothing) {
      follow_end(end, particle(left ? s : s + 1), time, gain);
      line_.seal(beside, time, faster);
    } else {
      (left ? left_ : right_).take(particle(left ? beside : beside + 1));
    }
  }
  // Takes in the next particle of a row.
  void take_in(End end) {
    const bool left = end == End::left;
    left ? range_.take_in_left() : range_.take_in_right(particles_->count());
    line_.load_mass(left ? first() : last() + 1, *particles_);
  }
  // The last particle of a line, or the wall there, has had a collision in which it gained velocity.
  template <class Gain> void follow_end(End end, ParticleIndex outermost, const T& time, const Gain& gain) {
    Anchor<T>& anchor = end == End::left ? left_ : right_;
    anchor.take(outermost);
    if (!walls_.has(end)) anchor.follow(flight(anchor, time), time, gain);
  }

  // What a wall has given, until a local time, to a particle that rests on it, at this gap or with this gap below it in
  // a pile.
  struct WallImpulse {
    End end;
    T energy{0}, momentum{0};
  };
  WallImpulse carried(Slot s, const T& time) const {
    const End end = wall_gaps_.piles() ? wall_gaps_.pile_end() : walls_.left_of(particle(s)) ? End::left : End::right;
    if (s < first() || s > last() || !(line_.gaps[s].gap == T(0) && closing(s) == T(0))) return {end};
    const Pair<T> since = line_.gaps.since_start(s);
    T rested(0);
    if (wall_gaps_.at_wall(particle(s))) {
      rested = wall_gaps_.approach(line_, s).rested(line_.gaps.flown(s, time), clock().since_start(time));
    } else {
      const std::optional<T> let_go = wall_gaps_.pile_let_go(line_, s);
      rested = line_.gaps.flown(s, let_go && *let_go < time ? *let_go : time);
    }
    if (!is_positive(rested)) return {end};
    const ParticleIndex wall = end == End::left ? -1 : count();
    const T mass = line_.masses[end == End::left ? s + 1 : s], a = wall_gaps_.acceleration();
    const Flight<T> from = at_wall(*particles_, wall, since), to = at_wall(*particles_, wall, since + rested);
    const T gained = difference(to.v, from.v);
    const WallMotion<T>* motion = particles_->wall(end)->motion.get();
    const bool jumps = motion != nullptr && motion->jumps();  // from under it, at the end
    const T way = jumps ? T(from.v.value() * rested) : difference(to.x, from.x);
    return {end, T(mass * (gained * (to.v.value() + from.v.value()) / T(2) - a * way)),
            T(mass * (gained - a * rested))};
  }

  struct Inner {  // collisions at the slots between these two are inner ones
    Slot after = 0, before = 0;
  };
  Inner inner_;
};

}  // namespace cradle
