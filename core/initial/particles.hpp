#pragma once
// The particles of a scene at the start: read-only initial data, numbered from left to right. Chains copy from here the
// particles that they hold; particles of a row that the front has not reached are in no chain, only here.

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "cradle/core/laws/wall.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

using ParticleIndex = std::int64_t;

struct GapRange {
  ParticleIndex first, last;  // a gap is numbered by the particle on its left; empty if last < first
};

// A line ends at both sides, and may have walls there (wall.hpp), which count as particles -1 and N: position and
// velocity are defined for them too, as are gap and closing speed of the gaps to them. On a ring of circumference L the
// last particle's neighbour on the right is the first one, at its position + L: as many gaps as particles, that of the
// last one included.

template <Real T> class Particles {
 public:
  virtual ~Particles() = default;

  virtual ParticleIndex count() const = 0;
  virtual T position(ParticleIndex particle) const = 0;
  virtual T velocity(ParticleIndex particle) const = 0;
  virtual T mass(ParticleIndex particle) const = 0;
  virtual bool identical_masses() const = 0;

  // L > 0; 0 for a line.
  virtual T circumference() const { return T(0); }
  bool on_ring() const { return is_positive(circumference()); }

  virtual const Wall<T>* wall(End) const { return nullptr; }
  bool walled() const { return wall(End::left) != nullptr || wall(End::right) != nullptr; }
  // Whether walls can give energy: one that moves, or heats.
  bool driven() const {
    const auto gives = [](const Wall<T>* w) { return w != nullptr && (w->temperature > 0 || !(w->speed == T(0))); };
    return gives(wall(End::left)) || gives(wall(End::right));
  }
  Walls<T> walls() const { return {wall(End::left), wall(End::right), count()}; }
  // All gaps that there are.
  GapRange gaps() const {
    if (on_ring()) return {0, count() - 1};
    return {wall(End::left) != nullptr ? -1 : 0, count() - (wall(End::right) != nullptr ? 1 : 2)};
  }

  // Distance and closing speed of `particle` and the next one, without the cancellation of a difference of positions.
  virtual T gap(ParticleIndex particle) const = 0;
  virtual T closing_speed(ParticleIndex particle) const = 0;

  // The gaps that a chain must hold from the start. The others have closing speed 0 and lie inside a row: nothing can
  // happen there before a neighbouring gap has had a collision.
  virtual GapRange gaps_in_motion() const { return {0, count() - 2}; }

  virtual T kinetic_energy() const = 0;
  virtual T momentum() const = 0;
  // The momentum of all particles, exact where the initial state knows it: a sum of rounded numbers need not be 0 where
  // the momentum is. Particles at rest against each other keep this momentum alone.
  virtual T conserved_momentum() const { return momentum(); }
  virtual T total_mass() const = 0;
  // Of particles [from, to).
  virtual T mass_between(ParticleIndex from, ParticleIndex to) const {
    CompensatedSum<T> sum;
    for (ParticleIndex particle = from; particle < to; ++particle) sum.add(mass(particle));
    return sum.value();
  }
  virtual T least_mass() const = 0;
  virtual T greatest_mass() const { return least_mass(); }
  // The position of a particle where it is a number of the scene, rounded as such; 0 where gaps are not made of
  // positions.
  virtual T rounded_place(ParticleIndex) const { return T(0); }
  // Position of the centre of mass; takes all particles.
  T centre_of_mass() const {
    CompensatedSum<T> moment;
    for (ParticleIndex particle = 0; particle < count(); ++particle) moment.add(mass(particle) * position(particle));
    return moment.value() / total_mass();
  }
  // What can be lost of it: the energy in the frame of the centre of mass, as far as the type resolves the difference.
  virtual T energy_to_lose() const {
    const T energy = kinetic_energy(), least = energy * T(std::numeric_limits<T>::epsilon()) * T(1024);
    const T p = momentum(), square = p * p, twice = T(2) * total_mass();
    const T own = energy - (is_finite(square) ? T(square / twice) : T(p * (p / twice)));
    return own < least ? least : own;
  }
  // Bounds the square of any speed to come, by a factor 2: energy is never gained, but from walls.
  T energy_over_least_mass() const { return kinetic_energy() / least_mass(); }
  // Bounds the square of the speed of any two against each other, for good; far away where walls give energy. Between
  // two particles it is at most E over half of their reduced mass, E in the frame of the centre of mass.
  T greatest_approach_squared() const {
    if (walls().give_energy()) return far_away<T>();
    const T energy = walled() ? kinetic_energy() : energy_to_lose();
    return T(4) * energy / least_mass();
  }
};

// A number as messages print it.
template <Real T> std::string in_message(const T& x) { return std::to_string(to_double(x)); }

// Throws std::invalid_argument unless the number is finite; `what` it is, as in "position of particle 3".
template <Real T> void require_finite(const T& x, const std::string& what) {
  if (!is_finite(x))
    throw std::invalid_argument(what + " is not finite (" + in_message(x) +
                                "): give a number within the range of the scalar type");
}

// Throws std::invalid_argument where mass, momentum or energy of all particles together is beyond the type's range.
template <Real T> void require_sums(const Particles<T>& particles) {
  const auto require = [](const T& sum, const char* what) {
    if (!is_finite(sum))
      throw std::invalid_argument(std::string(what) + " of all particles overflows (found no finite number): give "
                                                      "smaller masses or speeds, or a scalar type of a wider range");
  };
  require(particles.total_mass(), "the mass");
  require(particles.momentum(), "the momentum");
  require(particles.kinetic_energy(), "the kinetic energy");
}

// Checks what every chain requires of its particles. Throws std::invalid_argument.
template <Real T> void require_particles(const Particles<T>& particles, const T& start) {
  if (particles.count() < 1)
    throw std::invalid_argument("a chain without particles (" + std::to_string(particles.count()) +
                                "): give it at least one");
  require_finite(start, "time of the start");
  require_sums(particles);
}

}  // namespace cradle
