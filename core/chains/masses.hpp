#pragma once
// The masses of a chain's particles: one for all, or one for each. Identical masses cost neither memory nor the
// divisions of the reduced mass. Watched masses use a chain that estimates the effect of rounding on the sequence of
// collisions and, if they are far apart, keeps more digits of every closing speed (watched_gap.hpp).

#include <algorithm>
#include <limits>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

template <Real T> struct IdenticalMasses {
  // Throws std::invalid_argument if they are not identical.
  explicit IdenticalMasses(const Particles<T>& particles) : mass(particles.mass(0)), reduced_mass(mass / T(2)) {
    if (particles.identical_masses()) return;
    ParticleIndex other = 1;
    while (other + 1 < particles.count() && particles.mass(other) == mass) ++other;
    require(false, "unequal masses in a chain for identical ones (particle 0 has ", mass, ", particle ", other, " has ",
            particles.mass(other), "): use GapChain<T, IndividualMasses<T>>");
  }
  T mass, reduced_mass;
  static auto state(auto&) { return fields(); }
  IdenticalMasses without_slots() const { return *this; }
  bool fits(std::size_t) const { return true; }
  void resize(std::size_t) {}
  void copy(const IdenticalMasses&, Slot, Slot, std::size_t) {}
  void set(Slot, const T&) {}
  const T& operator[](Slot) const { return mass; }
  EqualMasses<T> of_pair(Slot) const { return {mass, reduced_mass}; }
};

template <Real T> struct IndividualMasses {
  IndividualMasses() = default;
  explicit IndividualMasses(const Particles<T>&) {}
  IndividualMasses without_slots() const { return IndividualMasses(); }
  std::vector<T> masses;  // of the particle on the left of each slot
  static auto state(auto& self) { return fields(self.masses); }
  bool fits(std::size_t slots) const { return masses.size() == slots; }
  void resize(std::size_t slots) { masses.resize(slots, T(1)); }
  void copy(const IndividualMasses& other, Slot from, Slot to, std::size_t particles) {
    std::copy_n(&other.masses[from], particles, &masses[to]);
  }
  void set(Slot s, const T& mass) { masses[s] = mass; }
  const T& operator[](Slot s) const { return masses[s]; }
  TwoMasses<T> of_pair(Slot s) const { return {masses[s], masses[s + 1]}; }
};

template <Real T> struct WatchedMasses : IndividualMasses<T> {
  using IndividualMasses<T>::IndividualMasses;
  static constexpr bool watched = true;
};
template <class Masses>
concept Watched = requires {
  requires Masses::watched;
};

// When particles share their energy, a closing speed loses the digits of a heavy one's velocity: as many as the root of
// the ratio of masses has; here two.
template <Real T> bool far_apart(const Particles<T>& particles) {
  return T(10000) * particles.least_mass() < particles.greatest_mass();
}
// Not in a type whose sums are not rounded to the nearest: double-double, which has enough digits.
template <Real T> inline constexpr bool sums_can_be_exact = std::numeric_limits<T>::is_exact || requires {
  requires std::numeric_limits<T>::round_style == std::round_to_nearest;
};
// Watching takes about three times the time per collision, so it is used for masses far apart and for few particles.
// Identical masses are watched if there are very few particles, and these are at a wall (a shaken wall makes errors
// grow, one at rest may stop a particle) or were placed one by one: round numbers make particles meet in threes, which
// rounding may draw apart.
template <Real T> bool to_be_watched(const Particles<T>& particles, bool placed_one_by_one) {
  if (particles.identical_masses()) return particles.count() <= 16 && (particles.walled() || placed_one_by_one);
  return particles.count() <= 1000 || far_apart(particles);
}

}  // namespace cradle
