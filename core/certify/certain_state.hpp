#pragma once
// What a proof (checker.hpp) says: where it is in doubt, and what is certain at a time. Certificates are made from it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "cradle/core/certify/certain_wall.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

enum class Check { neighbours, closing, later, side, gap, before, agreement, reaches, turns };

// Where a proof ends: two quantities of which the first should be less, or on one side of the second.
template <Enclosing N> struct Doubt {
  Check check = Check::gap;
  bool refuted = false;  // it is certain that it is not so; else it is open
  ParticleIndex left = -1, right = -1;
  N first{0}, second{0};
};

// The same of one of many collisions.
template <Enclosing N> struct DoubtAt {
  std::size_t number;  // of the collision
  Doubt<N> doubt;
};

// Collisions proved; those of them below a threshold, that merged, and that plain doubles decided (times and sides).
struct Proved {
  std::uint64_t collisions = 0, below_cutoff = 0, merges = 0, in_doubles = 0;
};

// What bounds the rounding of a run's particles (agreement.hpp), in plain doubles.
struct Sizes {
  std::uint64_t particles = 0;
  double mass = 0, least_mass = 0, start_energy = 0, start_speed = 0, place = 0;  // speed, place: the largest
  // Of walls: the largest speed of one, or of a particle that comes from one, and the energy that they have given,
  // without what they have taken.
  double wall_speed = 0, wall_energy = 0;
  double fall_energy = 0;  // what they can have gained by falling

  void add(double of_mass, double speed) {
    least_mass = particles++ == 0 ? of_mass : std::min(least_mass, of_mass);
    mass += of_mass;
    start_energy += of_mass * speed * speed / 2;
    start_speed = std::max(start_speed, std::abs(speed));
  }
};

// The last collision of a run.
template <Enclosing N> struct LastMeeting {
  ParticleIndex l = -1, r = -1;  // clusters, as they are after it: the same after a merger
  N time{0}, closing{0};
};

// What is certain at a time.
template <Enclosing N> struct CertainState {
  std::optional<Doubt<N>> doubt;
  N energy{0};            // kinetic
  N time{0}, closing{0};  // at a collision: of it
  CertainAccounts<N> walls;
  bool over = true;                          // no neighbours approach each other: there is no collision any more
  std::optional<N> front_left, front_right;  // places of the outermost particles that have collided, on a line
  // In powers of ten: the largest radius of a place, the smallest gap, the largest radius of one against itself.
  double widest = nothing, least_gap = -nothing, widest_of_gap = nothing;
  static constexpr double nothing = -std::numeric_limits<double>::infinity();
  Sizes sizes;  // of the particles held
};

}  // namespace cradle
