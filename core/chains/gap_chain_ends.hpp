#pragma once
// The ends of the active zone of a chain in gaps and closing speeds: how it takes in the particles that its fronts
// reach, collision by collision or, after a held range (segments.hpp), all at once; the slots for them.

#include "cradle/core/chains/gap_chain.hpp"

namespace cradle {

template <Real T, class Masses, class Field>
inline void GapChain<T, Masses, Field>::lay_out(const std::vector<Slot>& kept, ParticleIndex held) {
  const std::size_t slots = range_.lay_out(static_cast<std::size_t>(held), held / 2 + 8, kept);
  line_.particle_of_slot_0 = particles_->gaps().first + range_.unheld_left() - static_cast<ParticleIndex>(first());
  line_.gaps.lay_out(slots, first(), kept);
  memory_.lay_out(slots, first(), kept);
  line_.masses.resize(slots);
  for (Slot s = first(); s <= last() + 1; ++s) line_.load_mass(s, *particles_);
  find_inner();
}

template <Real T, class Masses, class Field>
inline void GapChain<T, Masses, Field>::continue_with(typename Line::Gaps& after, const FrontMove<T>& to_left,
                                                      const FrontMove<T>& to_right) {
  line_.gaps.swap_gaps(after);
  if (on_ring()) return;
  range_.reach(to_left.reached, to_right.reached);
  while (first() >= range_.front_left() && range_.beyond_left(first()) == HeldRange::Beyond::row) {
    range_.take_in_left();
    line_.load_mass(first(), *particles_);
  }
  while (last() <= range_.front_right() && range_.beyond_right(last()) == HeldRange::Beyond::row) {
    range_.take_in_right(particles_->count());
    line_.load_mass(last() + 1, *particles_);
  }
  walls_.continue_with(to_left.wall, to_right.wall);
  const ParticleIndex left = particle(range_.front_left()), right = particle(range_.front_right()) + 1;
  const GapRange all = particles_->gaps();
  if (left > all.first || walls_.has(End::left)) left_.take(std::max(left - 1, all.first));
  if (right < all.last + 1 || walls_.has(End::right)) right_.take(std::min(right + 1, all.last + 1));
  for (const auto& collision : to_left.at_end) follow_end(End::left, left, collision.time, T(-collision.handed));
  for (const auto& collision : to_right.at_end) follow_end(End::right, right, collision.time, collision.handed);
}

template <Real T, class Masses, class Field>
inline Notice GapChain<T, Masses, Field>::widen(Slot s, const T& time, const Outcome<T>& outcome) {
  range_.reach(s, s);
  if (s == range_.front_left()) {
    const HeldRange::Beyond beyond = range_.beyond_left(s);
    if (beyond == HeldRange::Beyond::row) {
      range_.take_in_left();
      line_.load(s - 1, *particles_, time);
      line_.load_mass(s - 1, *particles_);
    }
    if (beyond != HeldRange::Beyond::nothing) {
      left_.take(particle(s) - 1);
    } else {
      follow_end(End::left, particle(s), time, -line_.handed(s, outcome).left);
      line_.seal(s - 1, time, outcome.to_left);
    }
  }
  if (s == range_.front_right()) {
    const HeldRange::Beyond beyond = range_.beyond_right(s);
    if (beyond == HeldRange::Beyond::row) {
      range_.take_in_right(particles_->count());
      line_.load(s + 1, *particles_, time);
      line_.load_mass(s + 2, *particles_);
    }
    if (beyond != HeldRange::Beyond::nothing) {
      right_.take(particle(s) + 2);
    } else {
      follow_end(End::right, particle(s) + 1, time, line_.handed(s, outcome).right);
      line_.seal(s + 1, time, outcome.to_right);
    }
  }
  return range_.cramped(slots()) ? Notice::needs_slots : Notice::none;
}

}  // namespace cradle
