#pragma once
// One row of the time series: the state after all collisions at times <= t, in a few numbers. The ledger holds what
// walls have given as a negative loss; here the two are separated: what a wall dissipates is lost, the rest is given.
//
// If the ledger leaves half of the initial energy or more, the energy comes from the ledger, at constant cost; else it
// comes from the velocities of all particles (relative_motion.hpp), as it does if walls have given or taken some. The
// reason: at a collision c rounding adds an energy e_c to the state that the ledger does not contain. Later the energy
// E(t) of the state contains the share E(t)/E(t_c) of e_c, as of any other energy; the energy of the ledger misses the
// rest of e_c, which losses have removed. So the error of the former is sum e_c E(t)/E(t_c), that of the latter sum e_c
// (1 - E(t)/E(t_c)): it is zero for elastic particles; after particles have come to rest it is the sum of all e_c, more
// than the energy that is left. Besides, a ledger that leaves half is rounded to 2 eps of it. If many collisions lose
// much, losses have errors of their own: for Fig. 2 in double the error of the ledger is 3e-14 at t = 2000, where 74 %
// of the energy is left, and 6e-13 at t = 6500, where 19 % is left; that of the sum over velocities is 9e-15 and 7e-14
// (of double-double's energy).

#include <optional>

#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

template <Real T> struct Sample {
  T time{0};
  T energy{0};       // kinetic, of all particles of the scene
  T energy_lost{0};  // since the start, in collisions of particles and in walls
  T given{0};        // by walls, since the start
  Counts counts;
  ParticleIndex particles = 0;  // in the active zone, between the outermost two that have collided
  // Positions of these two; none before the first collision, nor on a ring.
  std::optional<T> front_left = {}, front_right = {};
  WallTallies<T> walls = {};
};

// A sample of a Simulation or a StickyGas. `time` must be between the last collision and the time advanced to.
template <class Run, Real T = typename Run::Scalar>
Sample<T> sample(const Run& run, const T& initial_energy, const T& time) {
  WallTallies<T> walls;  // of a wall that is not there, an empty one
  if constexpr (requires { run.wall_tallies(time); }) walls = run.wall_tallies(time);
  const T lost = run.energy_lost(time), given = given_by(walls), left = initial_energy - lost;
  // The ledger of particles that fall has potential energy too.
  bool summed = run.falls() || T(left + left) < initial_energy;
  for (const WallTally<T>& wall : walls) summed |= !(wall.given.value() == T(0) && wall.dissipated.value() == T(0));
  Sample<T> s{.time = time,
              .energy = summed ? T(run.kinetic_energy(time)) : left,
              .energy_lost = lost + given,
              .given = given,
              .counts = run.counts(),
              .particles = run.collided_particles(),
              .walls = walls};
  if (s.particles > 0 && !run.on_ring()) {
    s.front_left = run.front_left(time);
    s.front_right = s.particles == 1 ? s.front_left : run.front_right(time);  // each is computed from its own end
  }
  return s;
}

}  // namespace cradle
