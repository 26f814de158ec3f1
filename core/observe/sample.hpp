#pragma once
// One row of the time series: the state after all contacts at times <= t, in a few numbers, at constant cost.
// The ledger of losses holds what walls have given as a loss below zero; here the two are told apart.

#include <limits>
#include <optional>

#include "cradle/core/bodies.hpp"
#include "cradle/core/simulation.hpp"

namespace cradle {

template <Real T> struct Sample {
  T time{0};
  T energy{0};       // kinetic, of all bodies of the scene: initial energy minus the ledger of losses
  T energy_lost{0};  // since the start, in contacts of bodies
  T given{0};        // by walls, since the start
  Counts counts;
  BodyIndex bodies = 0;                      // in the active zone, between the outermost two that have collided
  std::optional<T> front_left, front_right;  // positions of these two; none before the first contact, nor on a ring
};

// Energy that walls have given to the bodies of a run.
template <class Run, Real T = typename Run::Scalar> T given_by_walls(const Run& run) {
  if constexpr (requires { run.given_by_walls(); })
    return run.given_by_walls();
  else if constexpr (requires { run.chain().walls(); })
    return run.chain().walls().given();
  else
    return T(0);
}

// Of a Simulation or a StickyGas. `time` must not be before the last contact made nor after the time advanced to.
template <class Run, Real T = typename Run::Scalar>
Sample<T> sample(const Run& run, const T& initial_energy, const T& time) {
  const T lost = run.energy_lost(), given = given_by_walls(run);
  Sample<T> s{time, initial_energy - lost, lost + given, given, run.counts(), run.collided_bodies(), {}, {}};
  if (s.bodies > 0 && !run.on_ring()) {
    s.front_left = run.front_left(time);
    s.front_right = run.front_right(time);
  }
  return s;
}

}  // namespace cradle
