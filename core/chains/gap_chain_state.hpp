#pragma once
// Checks of a chain in gaps and closing speeds that was loaded from a checkpoint: whether its parts fit together and
// its numbers are some that gaps can have.

#include "cradle/core/chains/gap_chain.hpp"

namespace cradle {

template <Real T, class Masses, class Field> inline void GapChain<T, Masses, Field>::loaded() {
  find_inner();
  const ParticleIndex count = particles_->count();
  const GapRange all = particles_->gaps();
  require_state(range_.fits(slots(), count) && range_.on_ring() == particles_->on_ring(), "slots");
  const ParticleIndex first_held = all.first + range_.unheld_left();
  require_state(line_.particle_of_slot_0 == first_held - static_cast<ParticleIndex>(first()), "particles");
  require_state(on_ring() ? particle(first()) == 0 && particle(last()) + 1 == count
                          : particle(last()) == all.last - range_.unheld_right(),
                "particles");
  require_state(line_.masses.fits(slots()) && (memory_.slots() == 0 || memory_.slots() == slots()), "lists");
  require_state(!on_ring() || (range_.front_left() == first() && range_.front_right() == last()), "seam");
  // No speed exceeds 1 + 2E/m >= sqrt(2E/m). Slots beyond the held gaps are filled again before use.
  const T fastest = particles_->walled() ? far_away<T>() : T(T(2) + T(4) * particles_->energy_over_least_mass());
  for (Slot s = first(); s <= last(); ++s) {
    const T& w = closing(s);
    require_state(
        fits(s) && is_finite(line_.gaps.lag(s)) && !(fastest < magnitude(w)) && line_.has_mass(s, *particles_), "gaps");
  }
  for (const Slot s : {first() - 1, last() + 1}) require_state(is_finite(closing(s)), "gaps");
  if constexpr (falls) {
    const auto pile = static_cast<std::size_t>(field_.resting()), held = last() + 1 - first();
    require_state(pile < held || (pile == held && !field_.pulls(particle(slot_in_pile(field_.resting())))), "pile");
    for (ParticleIndex h = 0; h < field_.resting(); ++h)
      require_state(line_.gaps[slot_in_pile(h)].gap == T(0) && closing(slot_in_pile(h)) == T(0), "pile");
  }
  require_state(line_.has_mass(last() + 1, *particles_), "masses");
  for (const Anchor<T>* anchor : {&left_, &right_})
    require_state(on_ring() || (anchor->particle() >= all.first && anchor->particle() <= all.last + 1), "anchors");
}

// Whether a loaded gap has numbers that a gap can have.
template <Real T, class Masses, class Field> inline bool GapChain<T, Masses, Field>::fits(Slot s) const {
  const auto& gap = line_.gaps[s];
  const auto has_due = [&] {
    if constexpr (keys_are_exact)
      return gap.due == gap.due;
    else
      return true;
  };
  if constexpr (falls)
    if (field_.pulls(particle(s)))  // it may be due while it opens
      return is_finite(gap.gap) && is_finite(gap.time) && is_finite(gap.closing) && has_due();
  return gap.fits(gap.closing);
}

}  // namespace cradle
