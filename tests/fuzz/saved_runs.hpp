#pragma once
// The runs whose states are fuzzed, by their number, which is the first byte of an input.

#include <functional>
#include <memory>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle::fuzz {

// Calls work(run) with the run of this number, which may be any.
template <class Work> void with_run(int number, const std::function<bool()>& interrupt, const Work& work) {
  static const auto rows =
      std::make_shared<Rows<double>>(symmetric_rows<double>(12, 0.5, 1, uniform_displacement(0.05, 3, 0)));
  static const auto ring =
      std::make_shared<Ring<double>>(8, 8., 1., gaussian_velocity(3, 0), uniform_displacement(0.05, 3, 0));
  const auto simulation = [&]<class Law, class Chain>(const Law& law, Chain chain) {
    Policy<double> policy;
    policy.interrupt = interrupt;
    work(Simulation<double, Law, Chain>(law, std::move(chain), policy));
  };
  const Inelastic<double> dry(0.9, 1e-3);
  const Wet<double> wet(0.01);
  const int kind = number % 7;
  if (kind == 0) return simulation(dry, GapChain<double>(rows, 0.));
  if (kind == 1) return simulation(dry, GapChain<double>(ring, 0.));
  if (kind == 2)
    return simulation(ContactTime<double>(dry, 1e-3), GapChain<double, IndividualMasses<double>>(rows, 0.));
  if (kind == 3) return simulation(dry, PositionChain<double>(rows, 0.));
  if (kind == 4) return simulation(wet, ClusterChain<double>(rows, 0.));
  if (kind == 5) return simulation(wet, ClusterChain<double>(ring, 0.));
  if (number & 8) return work(StickyGas<double>(rows, 0.));
  work(StickyGas<double>(ring, 0.));
}

}  // namespace cradle::fuzz
