#pragma once
// The masses of a chain's bodies: one for all, or one for each. Identical masses cost nothing, neither memory nor the
// divisions of the reduced mass.

#include <vector>

#include "cradle/core/bodies.hpp"
#include "cradle/core/event_queue.hpp"
#include "cradle/core/law.hpp"

namespace cradle {

template <Real T> struct IdenticalMasses {
  explicit IdenticalMasses(const Bodies<T>& bodies) : mass(bodies.mass(0)), reduced_mass(mass / T(2)) {}
  T mass, reduced_mass;
  void resize(std::size_t) {}
  void set(Slot, const T&) {}
  const T& operator[](Slot) const { return mass; }
  template <class Law> Outcome<T> outcome(const Law& law, Slot, const T& closing) const {
    return law(closing, reduced_mass);
  }
  template <class Law> Outcome<T> outcome(const Law& law, Slot, const T& closing, bool rested) const {
    return law(closing, reduced_mass, rested);
  }
};

template <Real T> struct IndividualMasses {
  explicit IndividualMasses(const Bodies<T>&) {}
  std::vector<T> masses;  // of the body on the left of each slot
  void resize(std::size_t slots) { masses.assign(slots, T(1)); }
  void set(Slot s, const T& mass) { masses[s] = mass; }
  const T& operator[](Slot s) const { return masses[s]; }
  template <class Law> Outcome<T> outcome(const Law& law, Slot s, const T& closing) const {
    return law(closing, masses[s], masses[s + 1]);
  }
  template <class Law> Outcome<T> outcome(const Law& law, Slot s, const T& closing, bool rested) const {
    return law(closing, masses[s], masses[s + 1], rested);
  }
};

}  // namespace cradle
