#pragma once
// A particle that rests on a wall (laws/wall_approach.hpp) in a chain in gaps: where it is, and what the wall gives it.
// While it is carried from x, v to x', v' in the time t, the wall gives it the momentum m (v' - v - a t) and the energy
// m (v'^2 - v^2)/2 - m a (x' - x), in no collision. They are entered in the accounts at its next one, and added to them
// when they are read before.

#include "cradle/core/chains/gap_chain.hpp"

namespace cradle {

template <Real T, class Masses, class Field>
typename GapChain<T, Masses, Field>::Carried GapChain<T, Masses, Field>::carried(Slot s, const T& time) const {
  const End end = walls_.left_of(particle(s)) ? End::left : End::right;
  if constexpr (falls) {
    if (s < first() || s > last() || !field_.pulls(particle(s))) return {end};
    if (!(line_.gaps[s].gap == T(0) && closing(s) == T(0))) return {end};
    const Pair<T> since = line_.gaps.since_start(s);
    const T rested = line_.approach(field_, s).rested(line_.gaps.flown(s, time), clock().since_start(time));
    if (!is_positive(rested)) return {end};
    const ParticleIndex wall = end == End::left ? -1 : count();
    const T mass = line_.masses[end == End::left ? s + 1 : s], a = field_.acceleration();
    const Flight<T> from = at_wall(*particles_, wall, since), to = at_wall(*particles_, wall, since + rested);
    const T gained = difference(to.v, from.v);
    const WallMotion<T>* motion = particles_->wall(end)->motion.get();
    const bool jumps = motion != nullptr && motion->shape() == Shape::sawtooth;  // from under it, at the end
    const T way = jumps ? T(from.v.value() * rested) : difference(to.x, from.x);
    return {end, T(mass * (gained * (to.v.value() + from.v.value()) / T(2) - a * way)),
            T(mass * (gained - a * rested))};
  }
  return {end};
}

template <Real T, class Masses, class Field>
Walls<T> GapChain<T, Masses, Field>::walls_at(const T& time) const requires(falls) {
  Walls<T> all = walls_;
  const auto carry = [&](const Carried& more) { all.carry(more.end, more.energy, more.momentum); };
  carry(carried(first(), time));
  if (first() < last()) carry(carried(last(), time));
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
