// Section IV, equations (4) to (7), and inelastic collapse.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/tools/theory/theory.hpp"

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

// Collisions of two rows that bounce, as a share of the collisions of infinite elastic rows, K(K + 1)/2, as a function
// of s = K (1-eps)/(1+eps). The points are counted in runs with eps = 0.999, N = 8000. Runs with N = 16000, and with
// eps = 0.992, follow them closely below s = 3; eps = 0.9 does within 10 to 20 %; eps = 0.5 does not. At first the
// share falls as ln(1+s)/s, since particles slow down: that is the share for the first particle of a row. From s = 1.8
// particles of the dense core collide repeatedly, more and more often up to inelastic collapse at s = 3.25.
struct Share {
  double s, share;
};
constexpr Share counted[] = {{0, 1},      {.125, .921}, {.25, .862}, {.375, .811},   {.5, .768},    {.75, .700},
                             {1, .650},   {1.25, .612}, {1.5, .583}, {1.75, .562},   {2, .586},     {2.25, .644},
                             {2.5, .716}, {2.75, .795}, {3, .897},   {3.127, 1.054}, {3.252, 1.642}};
constexpr const Share& last_counted = *std::rbegin(counted);

double share_of_elastic(double s) {
  if (s >= last_counted.s) return last_counted.share;
  const auto* above = std::ranges::upper_bound(counted, s, {}, &Share::s);
  const auto* below = above - 1;
  return below->share + (above->share - below->share) * (s - below->s) / (above->s - below->s);
}

// Collisions of rows that pass through each other before a collapse, at most: each particle meets every one of the
// other row. Then the rear of a row is faster than what is before it, since it met particles that had been slowed: from
// one particle to the next by (1 - eps)^2 u0 N/4, to second order in 1 - eps. So each row contracts, and all of its
// pairs meet near the time in which this speed makes the spacing. In runs with N from 60 to 1000 and N/N_c below 1/2,
// half of them have met at 1.1 to 1.4 times this, nearly all at 1.9 times. Closer to N_c there are more collisions, by
// factors of 1.05, 1.45 and 1.63 at N/N_c = 0.64, 0.80 and 0.83; from 0.9 on how many is not known.
std::optional<double> passing_rows(const Scene& scene, double particles, double of_collapse) {
  const double half = particles / 2, u0 = scene.initial.speed.value, l = scene.initial.spacing.value,
               lost = 1 - scene.law.restitution.value, passed = half * l / (2 * u0),
               contracted = (span(scene) - passed) * lost * lost * u0 * half / (2 * l);
  if (contracted < 0.9 || of_collapse == 0) return half * half;
  if (of_collapse > 0.9) return {};
  const double all = particles * (particles - 1) / 2 / (1 - std::pow(of_collapse, 5.5));
  return std::lerp(half * half, all, std::min(1., (contracted - 0.9) / 0.6));
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
  add_curves(table, shock, span(scene), through, lattice);
}

void bouncing_rows(const Scene& scene, Cost& cost) {
  const double eps = scene.law.restitution.value, kappa = (1 - eps) / (1 + eps);
  const double particles = static_cast<double>(scene.initial.particles);
  double met = layers(scene, span(scene));
  const auto onset = theory::collapse_onset_particles(eps);
  const bool may_collapse = onset && particles >= *onset;
  if (may_collapse && met * kappa > last_counted.s) {
    met = last_counted.s / kappa;
    cost.collapse = scene.run.start.value + span(scene) * met / layers(scene, span(scene));
  }
  cost.collisions = met * (met + 1) / 2 * share_of_elastic(met * kappa);
  if (may_collapse) return;
  const auto most = passing_rows(scene, particles, onset ? particles / *onset : 0);
  cost.collisions = most ? std::optional(std::min(*cost.collisions, *most)) : std::nullopt;
}

}  // namespace cradle::tools
