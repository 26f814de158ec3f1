// Section IV, equations (4) to (7), and inelastic collapse.
#include <algorithm>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/tools/theory/laws.hpp"

namespace cradle::tools {

namespace {

void add_curves(Predictions& table, const theory::InelasticShock<double>& shock, double until, double through,
                bool lattice) {
  // The curve of the front ends when it has turned around; (7) continues a little further, where it departs from the
  // run.
  const double end = std::min({until, through, 2 * theory::turnover_time(shock).value_or(until)});
  for (int k = 0; k <= curve_points; ++k) {
    const double t = curve_time(end, k);
    table.point("front_position", "(5)", "continuous", t, theory::front_position(shock, t));
    table.point("front_velocity", "(4)", "continuous", t, theory::front_velocity(shock, t));
    if (lattice) table.point("front_position", "x_n, t_n", "discrete", t, theory::front_position_discrete(shock, t));
    if (k > 0) {
      const double slope = theory::mean_velocity_slope(shock, t);
      table.point("interaction_density", "before (6)", "continuous", t, theory::interaction_density(shock, t));
      table.point("mean_velocity_slope", "(6), line 1", "continuous", t, slope);
      table.point("mean_velocity_slope", "(6), line 1", "printed", t, slope / shock.speed);
    }
    const double energy = theory::energy(shock, t);
    table.point("energy", "(7)", "continuous", t, energy);
    table.point("energy", "(7)", "printed", t, 2 * theory::initial_energy(shock) - energy);
  }
  for (int k = 0; k <= curve_points; ++k)
    table.point("energy_sticky", "section IV", "continuous", curve_time(until, k),
                theory::sticky_energy(shock, curve_time(until, k)));
}

}  // namespace

void predict_inelastic(const Scene& scene, Predictions& table) {
  if (unequal_masses(scene) || scene.law.cutoff_exponent) return;
  const double eps = scene.law.restitution.value;
  table.number("three_particle_collapse_limit", "7 - 4 sqrt 3", "continuous", theory::collapse_limit<double>(3));
  if (eps < 1) table.number("collapse_onset_particles", "N_c", "continuous", theory::collapse_onset_particles(eps));
  if (eps < 1) table.number("collapse_onset_particles", "McNamara, Young", "cushion", theory::cushion_particles(eps));
  if (!equal_rows(scene)) return;

  const theory::InelasticShock<double> shock{.restitution = eps,
                                             .speed = scene.initial.speed.value,
                                             .spacing = scene.initial.spacing.value,
                                             .particles = scene.initial.particles};
  table.number("initial_energy", "N m u0^2/2", "continuous", theory::initial_energy(shock));
  const bool lattice = scene.initial.positions == Positions::lattice;
  const double through = theory::front_collision(shock, scene.initial.particles / 2).time;  // the other row
  if (const auto turned = theory::turnover_collision(shock); turned && turned->time <= through) {
    table.time("turnover_time", "(4) = 0", "continuous", theory::turnover_time(shock));
    table.number("maximal_front", "x_max", "continuous", theory::maximal_front(shock));
    if (lattice) table.time("turnover_time", "t_n", "discrete", turned->time);
    if (lattice) table.number("maximal_front", "max(x_n - x_0)", "discrete", turned->position - shock.origin());
  }
  table.number("mean_velocity_slope", "(6), line 2", "continuous", theory::mean_velocity_slope_early(shock));
  if (const auto onset = theory::collapse_onset_time(shock); onset && *onset <= through)
    table.time("collapse_onset_time", "N_c/(2 u0)", "continuous", onset);
  add_curves(table, shock, scene.run.until.value - scene.run.start.value, through, lattice);
}

}  // namespace cradle::tools
