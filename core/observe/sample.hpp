#pragma once
// One row of the time series: the state after all contacts at times <= t, in a few numbers, at constant cost.

#include <limits>
#include <optional>

#include "cradle/core/bodies.hpp"
#include "cradle/core/simulation.hpp"

namespace cradle {

template <Real T> struct Sample {
  T time{0};
  T energy{0};       // kinetic, of all bodies of the scene: initial energy minus the ledger of losses
  T energy_lost{0};  // since the start
  Counts counts;
  BodyIndex bodies = 0;                      // in the active zone: from the outermost that has collided to the other
  std::optional<T> front_left, front_right;  // where those are; none before the first contact, nor on a ring
};

// `time` must not be before the last contact made nor after the time the run was advanced to.
template <Real T, class Law, class Chain>
Sample<T> sample(const Simulation<T, Law, Chain>& run, const T& initial_energy, const T& time) {
  const Chain& chain = run.chain();
  Sample<T> s{time, initial_energy - run.energy_lost(), run.energy_lost(), run.counts(), chain.collided_bodies(), {},
              {}};
  if (s.bodies > 0 && !chain.on_ring()) {
    const T local = chain.local_time(time);
    s.front_left = chain.front_left(local);
    s.front_right = chain.front_right(local);
  }
  return s;
}

}  // namespace cradle
