#pragma once
// Collisions at and beside walls under gravity, or where walls are shaken, in a chain in gaps; particles that rest on a
// wall (laws/wall_approach.hpp): where they are, and what the wall gives them.
//
// Several particles that rest on a wall are a pile (README.md, Piles). All gaps below the topmost one are 0 and closed,
// and the gap above it is one to the wall (gravity.hpp). All of its particles are let go at the same time, but in gaps
// nothing happens before the next collision beside the pile, which dissolves it. A particle that sits on the wall again
// begins a new pile.
//
// While a particle is carried from x, v to x', v' in the time t, the wall gives it the momentum m (v' - v - a t) and
// the energy m (v'^2 - v^2)/2 - m a (x' - x), in no collision. Both are entered in the accounts when the particle's gap
// next changes; where accounts are read before, both are added.

#include "cradle/core/chains/gap_chain.hpp"

namespace cradle {

template <Real T, class Masses, class Field>
template <class Law>
inline Outcome<T> GapChain<T, Masses, Field>::outcome_at_wall(const Law& law, Slot s, const T& time) {
  bool rested = true;
  if constexpr (LawWithMemory<Law, T>)
    rested = memory_.rested({left(s), s, right(s)}, s, time, law.contact_time(), local_time(start()), slots());
  if constexpr (falls) {
    const ParticleIndex wall = walls_.beside(particle(s)) ? particle(s) : field_.wall_of_pile();
    const T w = closing_when_due(s), &mass = line_.masses[walls_.left_of(wall) ? s + 1 : s];
    const Pair<T> elapsed = clock().since_start(time);
    if constexpr (Line::watched) {
      const auto at = [&](const T& speed) {
        line_.certainty.threshold(line_.gaps, line_.motion(field_), s, particle(s), time, w, speed);
      };
      at(field_.rest_speed(particle(s)));
      if constexpr (requires { law.cutoff(); }) at(law.cutoff());
    }
    const bool stays = field_.holds(particle(s), w, elapsed), elastic = !stays && (!rested || below_cutoff(law, w));
    const T restitution = stays ? T(0) : elastic ? T(1) : walls_.wall(wall).restitution;
    Outcome<T> outcome = walls_.strike(wall, w, mass, restitution, field_.shaken_at(wall, elapsed));
    outcome.below_cutoff = elastic && walls_.wall(wall).reflects();
    return outcome;
  } else {
    return walls_.strike(particle(s), closing(s), line_.masses[walls_.left_of(particle(s)) ? s + 1 : s]);
  }
}

template <Real T, class Masses, class Field> inline void GapChain<T, Masses, Field>::foresee_walls() {
  if constexpr (falls) {
    for (const Slot s : {first(), last()})
      if (field_.at_wall(particle(s))) line_.foresee(field_, s);
    if (field_.resting() > 0)
      if (const Slot above = slot_in_pile(field_.resting()); field_.above_pile(particle(above)))
        line_.foresee(field_, above);
  }
}

template <Real T, class Masses, class Field>
template <class Law>
CollisionResult<T> GapChain<T, Masses, Field>::collide_falling(const Law& law, Slot s, const T& time) {
  const ParticleIndex resting = field_.resting(), height = field_.piles() ? field_.height(particle(s)) : 0;
  const bool beside_pile = field_.piles() && height <= resting + 1;
  bool let_go = false;
  if (beside_pile && resting > 0) {
    const std::optional<T> at = line_.pile_let_go(field_, s);
    let_go = height < resting || (at && *at < time);
  }
  const bool on_pile = !let_go && beside_pile && resting > 0 && height == resting && stays(s, time);
  const bool at_wall = walls_.beside(particle(s)) || on_pile;
  const Outcome<T> of_law = at_wall ? outcome_at_wall(law, s, time) : outcome(law, s, time, closing_when_due(s));
  const bool on_wall = beside_pile && height == 0 && of_law.closing == T(0) &&  // slow, or of a restitution 0
                       field_.wall_presses(clock().since_start(time));
  const ParticleIndex after = let_go                                            ? ParticleIndex{on_wall}
                              : on_pile || on_wall                              ? resting + 1
                              : beside_pile && height == resting && resting > 0 ? resting - 1
                                                                                : resting;
  for (const Slot beside : {s - 1, s, s + 1})
    if (field_.at_wall(particle(beside)) && !(on_pile && resting == 1)) enter_carried(beside, time);
  if (let_go)
    for (ParticleIndex h = height > 1 ? 0 : 1; h < resting; ++h) enter_carried(slot_in_pile(h), time);
  else if (after < resting && resting > 1)
    enter_carried(slot_in_pile(resting - 1), time);
  const End far = field_.pile_end() == End::left ? End::right : End::left;
  if (resting == count() && after < resting && !walls_.has(far)) {  // the flight of the last one is its own again
    Anchor<T>& last_one = far == End::left ? left_ : right_;
    last_one.follow(flight(last_one, time), time, T(0));
  }
  const Notice notice = widen(s, time, of_law);
  // Of a pile that is let go, the gaps above it and below it that are not beside the collision are brought to its time.
  const auto renew = [&] {
    Notice more = Notice::none;
    if (let_go)
      for (const ParticleIndex h : {resting, ParticleIndex{0}})
        if ((h + 1 < height || h > height + 1) && field_.pulls(particle(slot_in_pile(h))))
          more |= line_.renew(field_, slot_in_pile(h), time) | Notice::origin_must_move;  // which predicts them
    return more;
  };
  CollisionResult<T> made = line_.strike(field_, s - 1, s, s + 1, time, of_law, notice, after, renew);
  if (const auto back = rebound(s); back && back->height < line_.gaps.floor()) made.notice |= Notice::gap_below_floor;
  find_inner();
  return made;
}

template <Real T, class Masses, class Field>
typename GapChain<T, Masses, Field>::Carried GapChain<T, Masses, Field>::carried(Slot s, const T& time) const {
  const End end = field_.piles() ? field_.pile_end() : walls_.left_of(particle(s)) ? End::left : End::right;
  if (s < first() || s > last() || !(line_.gaps[s].gap == T(0) && closing(s) == T(0))) return {end};
  const Pair<T> since = line_.gaps.since_start(s);
  T rested(0);
  if (field_.at_wall(particle(s))) {
    rested = line_.approach(field_, s).rested(line_.gaps.flown(s, time), clock().since_start(time));
  } else {
    const std::optional<T> let_go = line_.pile_let_go(field_, s);
    rested = line_.gaps.flown(s, let_go && *let_go < time ? *let_go : time);
  }
  if (!is_positive(rested)) return {end};
  const ParticleIndex wall = end == End::left ? -1 : count();
  const T mass = line_.masses[end == End::left ? s + 1 : s], a = field_.acceleration();
  const Flight<T> from = at_wall(*particles_, wall, since), to = at_wall(*particles_, wall, since + rested);
  const T gained = difference(to.v, from.v);
  const WallMotion<T>* motion = particles_->wall(end)->motion.get();
  const bool jumps = motion != nullptr && motion->shape() == Shape::sawtooth;  // from under it, at the end
  const T way = jumps ? T(from.v.value() * rested) : difference(to.x, from.x);
  return {end, T(mass * (gained * (to.v.value() + from.v.value()) / T(2) - a * way)), T(mass * (gained - a * rested))};
}

template <Real T, class Masses, class Field> void GapChain<T, Masses, Field>::enter_carried(Slot s, const T& time) {
  const Carried more = carried(s, time);
  if (more.momentum == T(0)) return;
  walls_.carry(more.end, more.energy, more.momentum);
  line_.gaps.lose(s, T(-more.energy));
}

template <Real T, class Masses, class Field>
Walls<T> GapChain<T, Masses, Field>::walls_at(const T& time) const requires(falls) {
  Walls<T> all = walls_;
  const auto carry = [&](Slot s) {
    const Carried more = carried(s, time);
    all.carry(more.end, more.energy, more.momentum);
  };
  if (field_.at_wall(particle(first()))) carry(first());
  if (first() < last() && field_.at_wall(particle(last()))) carry(last());
  for (ParticleIndex h = 1; h < field_.resting(); ++h) carry(slot_in_pile(h));
  return all;
}

template <Real T, class Masses, class Field> Flight<T> GapChain<T, Masses, Field>::from_wall(const T& time) const {
  const bool left = particles_->holding() == particles_->wall(End::left);
  const Slot s = left ? first() : last();
  const T gap = gap_at(s, time), closing = closing_at(s, time);
  const Flight<T> wall = at_wall(*particles_, left ? -1 : count(), clock().since_start(time));
  return left ? Flight<T>{wall.x + gap, wall.v - closing} : Flight<T>{wall.x - gap, wall.v + closing};
}

}  // namespace cradle
