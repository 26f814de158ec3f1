#pragma once
// The particles of a scene at the start: read-only initial data, numbered from left to right. Chains copy the particles
// that they hold; particles of a row that the front has not reached are only here.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "cradle/core/base/require.hpp"
#include "cradle/core/laws/wall.hpp"

namespace cradle {

using ParticleIndex = std::int64_t;

struct GapRange {
  ParticleIndex first, last;  // a gap is numbered by the particle on its left; empty if last < first
};

// A line has two ends and may have walls there (wall.hpp), which count as particles -1 and N: they have a position and
// a velocity too, and the gaps to them a gap and a closing speed. On a ring of circumference L the right neighbour of
// the last particle is the first one, at its position + L: there are as many gaps as particles.

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
  // One of them moves or is thermal.
  bool walls_give_energy() const { return walls().give_energy(); }
  Walls<T> walls() const { return {wall(End::left), wall(End::right), count()}; }
  // The wall with a particle's number; null if it is none.
  const Wall<T>* wall_at(ParticleIndex particle) const {
    return particle < 0 ? wall(End::left) : particle >= count() ? wall(End::right) : nullptr;
  }
  bool shaken(ParticleIndex particle) const {
    const Wall<T>* wall = wall_at(particle);
    return wall != nullptr && wall->motion != nullptr;
  }
  // The wall on which particles can rest; null if there is none.
  const Wall<T>* holding() const {
    for (const End end : {End::left, End::right})
      if (const Wall<T>* wall = this->wall(end); wall != nullptr && wall->holds()) return wall;
    return nullptr;
  }
  bool shaken() const { return shaken(-1) || shaken(count()); }
  // How far a shaken wall is from its place, and its speed there, a time after the start; 0 of all others.
  struct Shift {
    T x{0}, v{0};
  };
  Shift shift(ParticleIndex particle, const Pair<T>& elapsed) const {
    if (!shaken(particle)) return {};
    const WallMotion<T>& motion = *wall_at(particle)->motion;
    const Displaced<T> wall = motion.moment(elapsed).wall;
    return particle < 0 ? Shift{wall.place, wall.speed} : Shift{T(-wall.place), T(-wall.speed)};
  }

  // The constant acceleration of all particles, positive to the right. Walls do not fall.
  virtual T acceleration() const { return T(0); }
  bool fall() const { return !(acceleration() == T(0)); }
  bool falls(ParticleIndex particle) const { return fall() && particle >= 0 && particle < count(); }
  // The wall towards which they fall; null if there is none.
  const Wall<T>* floor() const {
    return !fall() ? nullptr : wall(is_negative(acceleration()) ? End::left : End::right);
  }
  // The potential energy at the start, -a sum m x: 0 at x = 0.
  virtual T potential_energy() const { return T(0); }
  T mechanical_energy() const { return kinetic_energy() + potential_energy(); }
  // The range of all gaps.
  GapRange gaps() const {
    if (on_ring()) return {0, count() - 1};
    return {wall(End::left) != nullptr ? -1 : 0, count() - (wall(End::right) != nullptr ? 1 : 2)};
  }

  // Distance and closing speed of `particle` and the next one, without the cancellation in a difference of positions.
  virtual T gap(ParticleIndex particle) const = 0;
  virtual T closing_speed(ParticleIndex particle) const = 0;

  // A velocity that all particles have but for small differences; 0 if there is none.
  virtual T common_velocity() const { return T(0); }
  // The velocity of a particle less that of the centre of mass, without the cancellation where velocities are common.
  virtual T relative_velocity(ParticleIndex particle, const T& of_centre) const {
    return velocity(particle) - of_centre;
  }

  // The gaps that a chain must hold from the start. The others have closing speed 0 and are inside a row: nothing can
  // happen there before a neighbouring gap has had a collision.
  virtual GapRange gaps_in_motion() const { return {0, count() - 2}; }

  virtual T kinetic_energy() const = 0;
  virtual T momentum() const = 0;
  // The momentum of all particles, exact if the initial state knows it: a sum of rounded numbers may differ from an
  // exact 0. Particles without relative motion have this momentum only.
  virtual T conserved_momentum() const { return momentum(); }
  virtual T total_mass() const = 0;
  // Mass of particles [from, to).
  virtual T mass_between(ParticleIndex from, ParticleIndex to) const {
    CompensatedSum<T> sum;
    for (ParticleIndex particle = from; particle < to; ++particle) sum.add(mass(particle));
    return sum.value();
  }
  virtual T least_mass() const = 0;
  virtual T greatest_mass() const { return least_mass(); }
  // The position of a particle if it is a number of the scene, rounded as such; 0 if gaps are not differences of
  // positions.
  virtual T rounded_place(ParticleIndex) const { return T(0); }
  // Position of the centre of mass; reads all particles.
  T centre_of_mass() const {
    CompensatedSum<T> moment;
    for (ParticleIndex particle = 0; particle < count(); ++particle) moment.add(mass(particle) * position(particle));
    return moment.value() / total_mass();
  }
  // The largest possible loss: the energy in the frame of the centre of mass, as far as the type resolves it.
  virtual T energy_to_lose() const {
    const T energy = kinetic_energy(), least = energy * T(std::numeric_limits<T>::epsilon()) * T(1024);
    const T p = momentum(), square = p * p, twice = T(2) * total_mass();
    const T own = energy - (is_finite(square) ? T(square / twice) : T(p * (p / twice)));
    return own < least ? least : own;
  }
  // The largest kinetic energy until a time since the start. It is at most E = mechanical_energy() if there is a floor,
  // since the potential energy is least with all particles there. Without one, particles fall for the time t, and
  // (sqrt(E) + sqrt(M/2) a t)^2 <= 2 E + M a^2 t^2.
  T most_kinetic_energy(const T& elapsed) const {
    const T energy =
        walls_give_energy() ? T(kinetic_energy() + energy_to_lose()) : T(kinetic_energy() + energy_of_fall());
    if (!fall() || floor() != nullptr) return energy;
    const T speed = acceleration() * elapsed;
    return T(2) * energy + total_mass() * (speed * speed);
  }
  // What particles gain at most by falling to the floor.
  T energy_of_fall() const {
    if (floor() == nullptr) return T(0);
    const T from_first = magnitude(T(position(0) - floor()->position)),
            from_last = magnitude(T(position(count() - 1) - floor()->position)),
            below = floor()->motion != nullptr ? floor()->motion->amplitude() : T(0);
    return magnitude(acceleration()) * total_mass() * ((from_first < from_last ? from_last : from_first) + below);
  }
  // Bounds the square of all future speeds, up to a factor 2: only walls add energy.
  T energy_over_least_mass() const { return kinetic_energy() / least_mass(); }
  // Bounds the square of all future relative speeds; very large if walls give energy. For two particles it is at most E
  // over half of their reduced mass, E in the frame of the centre of mass.
  T greatest_approach_squared() const {
    if (walls().give_energy()) return far_away<T>();
    const T energy = walled() ? kinetic_energy() : energy_to_lose();
    return T(4) * energy / least_mass();
  }
};

// Throws std::invalid_argument if the total mass, momentum or energy of the particles, or their moment, by which
// positions are found, is beyond the type's range.
template <Real T> void require_sums(const Particles<T>& particles) {
  const auto require_sum = [](const T& sum, const char* what) {
    require(is_finite(sum), what,
            " of all particles overflows (found no finite number): give smaller masses or speeds, or a scalar type of "
            "a wider range");
  };
  const T energy = particles.kinetic_energy(), least = std::numeric_limits<T>::min();
  require_sum(particles.total_mass(), "the mass");
  require_sum(particles.momentum(), "the momentum");
  require_sum(energy, "the kinetic energy");
  const auto require_digits = [](bool held, const char* what, const char* to_do) {
    require(held, what, " underflows (found less than the type holds with all its digits): give larger masses or ",
            to_do, ", or a scalar type of a wider range");
  };
  const T farthest = std::max(magnitude(particles.position(0)), magnitude(particles.position(particles.count() - 1)));
  require_digits(farthest == T(0) || !(T(particles.total_mass() * farthest) < least),
                 "the mass times the position of all particles", "distances");
  if (!(T(energy * T(std::numeric_limits<T>::epsilon())) < least)) return;
  bool move = is_positive(energy);  // particles at rest have no energy; the first million are checked
  for (ParticleIndex k = 0; k < std::min(particles.count(), ParticleIndex{1} << 20) && !move; ++k)
    move = !(particles.velocity(k) == T(0));
  require_digits(!move, "the kinetic energy of all particles", "speeds");
}

// For random states: throws std::invalid_argument for no particles, or more than their numbers are made for.
inline void require_countable(ParticleIndex count, const std::string& what) {
  require(count >= 1 && count < std::int64_t{1} << 31, what, " of ", count, " particles: give it from 1 to 2147483647");
}

// For chains without gravity and shaken walls. Throws std::invalid_argument; `what_to_do` ends the message.
template <Real T> void require_no_gravity(const Particles<T>& particles, const std::string& what_to_do) {
  require(!particles.fall(), "particles under gravity in a chain without it (acceleration ", particles.acceleration(),
          "): ", what_to_do);
  for (const End end : {End::left, End::right})
    if (const Wall<T>* wall = particles.wall(end); wall != nullptr && wall->motion != nullptr)
      require(false, "a shaken wall in a chain without them (amplitude ", wall->motion->amplitude(), "): ", what_to_do);
}

// Checks the requirements of all chains. Throws std::invalid_argument.
template <Real T> void require_particles(const Particles<T>& particles, const T& start) {
  require(particles.count() >= 1, "a chain without particles (", particles.count(), "): give it at least one");
  require_finite(start, "time of the start");
  require_sums(particles);
}

}  // namespace cradle
