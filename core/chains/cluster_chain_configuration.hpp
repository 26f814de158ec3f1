#pragma once
// The configuration of a chain in gaps and particle velocities, in positions: the particles that have collided and the
// next one on each side; before the first collision all held particles; on a ring all, from the first one right of x =
// 0. They are computed from a particle that has not collided, the one at the left end if there is one, else from the
// centre of mass. If there is one at either end, or on a ring, the sum of the gaps can be checked; closing speeds are
// differences of velocities and always add up.

#include "cradle/core/chains/cluster_chain.hpp"

namespace cradle {

// Particles that are not held move like the outermost held one.
template <Real T> T ClusterChain<T>::kinetic_energy(const T&) const {
  const T total = particles_->total_mass();
  const auto moving = relative_motion(total, T(0), [&](const T& c, const auto& add) {
    for (Slot s = first();; s = right(s)) {
      const Cell<T>& cell = line_.gaps[s];
      T mass = cell.mass;
      if (s == first()) mass += particles_->mass_between(0, range_.unheld_left());
      if (s == last()) mass += particles_->mass_between(count() - range_.unheld_right(), count());
      add(mass, T(cell.velocity - c));
      if (s == last()) break;
    }
  });
  const T momentum = particles_->conserved_momentum();
  return momentum * momentum / (total + total) + moving.energy;
}

template <Real T> Configuration<T> ClusterChain<T>::configuration(const T& time) const {
  const bool collided = range_.has_fronts();
  const Slot from = collided && range_.front_left() > first() ? left(range_.front_left()) : first();
  const Slot to = collided && range_.front_right() < last() ? right(range_.front_right()) : last();
  Configuration<T> c;
  c.time = clock().time(time);
  // A particle that has not collided has its initial number. If all particles at an end have collided, they are
  // numbered from the end of the line.
  const bool free_left = !on_ring() && (!collided || from != range_.front_left());
  const bool free_right = !on_ring() && (!collided || to != range_.front_right());
  c.from = free_left ? particle(from) : 0;
  c.to = free_right ? particle(to) : particles_->count() - 1;
  CompensatedSum<T> way, moment, mass;
  std::vector<T> ways;
  for (Slot s = from;; s = right(s)) {
    const Cell<T>& cell = line_.gaps[s];
    c.index.push_back(cell.particle);
    c.m.push_back(cell.mass);
    c.v.push_back(cell.velocity + frame_);
    ways.push_back(way.value());
    moment.add(cell.mass * ways.back());
    mass.add(cell.mass);
    if (s == to && !on_ring()) break;
    c.gap.push_back(gap_at(s, time));
    c.closing_speed.push_back(closing(s));
    way.add(c.gap.back());
    if (s == to) break;
  }
  Pair<T> leftmost;
  if (free_left) {
    leftmost = undisturbed_place(from, time);
    if (free_right) c.closure_gap = difference(undisturbed_place(to, time), leftmost + way.sum + way.errors);
  } else if (free_right) {
    leftmost = undisturbed_place(to, time) - way.value();
  } else {
    leftmost = two_sum(centre_ ? *centre_ : particles_->centre_of_mass(), T(frame_ * clock().elapsed(time)));
    leftmost = leftmost - T((moment.value() - carried_.value() * particles_->circumference()) / mass.value());
  }
  for (const T& w : ways) c.x.push_back((leftmost + w).value());
  if (collided || on_ring()) c.collided_from = free_left ? 1 : 0, c.collided_to = c.x.size() - (free_right ? 1 : 0);
  if (on_ring()) {
    c.closure_gap = particles_->circumference() - way.value();
    fold(c, particles_->circumference());
  }
  return c;
}

}  // namespace cradle
