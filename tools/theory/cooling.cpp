// Free cooling on a ring: the law that, according to the paper, all three gases follow in the end, and Haff's law for
// the early stage of the inelastic gas. Times are evenly spaced in the logarithm.
#include <cmath>

#include "cradle/core/theory/free_cooling.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

// The sticky gas is that of infinitely many particles: its curve ends where so many clusters are left.
constexpr double few = 10;

void predict_cooling(const Scene& scene, Predictions& table) {
  const auto particles = static_cast<double>(scene.initial.particles);
  const theory::FreeCooling gas{scene.initial.variance.value, particles / scene.initial.length.value};
  const double until = span(scene);
  const double flight = 1 / (gas.density * std::sqrt(gas.variance));  // a mean spacing at the thermal speed
  const bool dry = scene.law.type == LawType::inelastic;
  if (!(until > flight) || (dry && scene.law.restitution == Decimal("1"))) return;
  if (dry) table.number("haff_time", "Haff 1983", "continuous", theory::haff_time(gas, scene.law.restitution.value));
  for (int k = 0; k <= curve_points; ++k) {
    const double t = flight * std::pow(until / flight, static_cast<double>(k) / curve_points);
    const double clusters = particles * theory::sticky_clusters_per_particle(gas, t);
    if (clusters > few) {
      table.point("energy_sticky", "t^(-2/3)", "continuous", t, particles * theory::sticky_energy_per_particle(gas, t));
      if (scene.law.type == LawType::sticky) table.point("clusters", "t^(-2/3)", "continuous", t, clusters);
    }
    if (dry)
      table.point("energy_haff", "Haff 1983", "continuous", t,
                  (particles - 1) * theory::haff_energy_per_particle(gas, scene.law.restitution.value, t));
  }
}

}  // namespace cradle::tools
