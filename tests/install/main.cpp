// An example of a user's program: two rows of inelastic particles run into each other (a small version of the scene
// fig2), once and as an ensemble. It shows that an installed Cradle compiles and runs outside its own tree, with the
// libraries that it needs; the exit status says whether the energy balance is right.

#include <cmath>
#include <iostream>
#include <memory>

#include <cradle/core/chains/gap_chain.hpp>
#include <cradle/core/engine/simulation.hpp>
#include <cradle/core/ensemble/ensemble.hpp>
#include <cradle/core/initial/rows.hpp>
#include <cradle/core/laws/law.hpp>

namespace {

using namespace cradle;

std::shared_ptr<const Rows<double>> rows_of(ReplicaIndex replica) {
  return std::make_shared<Rows<double>>(symmetric_rows(400, 0.5, 1.0, uniform_displacement(0.05, 1, replica)));
}

}  // namespace

int main() {
  const auto rows = rows_of(0);
  const Inelastic<double> law(0.99, 1e-5);
  Simulation<double, Inelastic<double>, GapChain<double>> shock(law, GapChain<double>(rows, 0.0));

  const double time = 150;
  shock.advance(time);

  const auto particles = shock.chain().configuration(shock.chain().local_time(time));
  double kinetic = 0;  // of the active zone; the particles outside it still move at 1/2
  for (const double v : particles.v) kinetic += v * v / 2;
  kinetic += static_cast<double>(rows->count() - static_cast<ParticleIndex>(particles.v.size())) / 8;
  const double ledger = rows->kinetic_energy() - shock.energy_lost();
  std::cout << shock.counts().collisions << " collisions, energy " << kinetic << '\n';

  Ensemble energies;
  run_replicas(TbbExecutor(2), {0, 10}, energies, [&](ReplicaIndex k) {
    Simulation replica(law, GapChain<double>(rows_of(k), 0.0));
    replica.advance(time);
    return std::vector<double>{rows->kinetic_energy() - replica.energy_lost()};
  });
  const Moments statistics = energies.statistics();
  std::cout << "of 10 replicas " << statistics.mean[0] << " +- " << statistics.standard_error(0) << '\n';
  const bool within = statistics.least[0] <= ledger && ledger <= statistics.greatest[0];

  // Each of the 400 velocities is a sum of as many closing speeds of size one and below.
  return within && std::abs(kinetic - ledger) < 400 * 400 * 2.3e-16 ? 0 : 1;
}
