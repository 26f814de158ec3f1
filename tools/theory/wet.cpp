// Sections V and VI: the front (8), the energy before particles stick, the linear model of the zone (9) to (17).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/core/theory/wet_energy.hpp"
#include "cradle/core/theory/wet_shock.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

// Discrete forms are computed collision by collision: so many take some tenths of a second.
constexpr double most_collisions = 3e7;
// Values of s = E_loss t/(m u0 l): the series for the energy is good to 2e-4 up to the first; at the second all
// particles have stuck.
constexpr double last_progress = 1.1, sticking_progress = 1.2;

void add_front(Predictions& table, const theory::WetShock<double>& shock, double until, bool lattice) {
  const theory::WetFront<double> front(shock);
  const auto through = static_cast<double>(shock.particles / 2);  // collisions with all of the other row
  const auto turned = front.turnover();
  if (turned && turned->collisions <= through) {
    table.time("turnover_time", "(8)", "continuous", turned->time);
    table.number("turnover_collisions", "(8)", "continuous", turned->collisions);
    table.number("maximal_front", "(8)", "continuous", turned->position - shock.origin());
    if (lattice && turned->collisions < most_collisions)
      if (const auto last = theory::turnover_collision(shock)) {
        table.time("turnover_time", "t_n", "discrete", last->time);
        table.number("turnover_collisions", "n", "discrete", static_cast<double>(last->collision));
        table.number("maximal_front", "max(x_n - x_0)", "discrete", last->position - shock.origin());
      }
  }
  const double end = turned ? std::min(until, 2 * turned->time) : until;
  theory::WetFrontRecursion<double> recursion(shock);
  const bool step_by_step = lattice && 2 * shock.speed * end / shock.spacing < most_collisions;
  for (int k = 0; k <= curve_points; ++k) {
    const double t = curve_time(end, k);
    if (const auto here = front.at_time(t)) {
      if (here->collisions > through) break;
      table.point("front_position", "(8)", "continuous", t, here->position);
      table.point("front_velocity", "(8)", "continuous", t, here->velocity);
    }
    if (!step_by_step) continue;
    recursion.advance_to(t);
    if (const auto place = recursion.position_at(t)) {
      table.point("front_position", "x_n, t_n", "discrete", t, *place);
      table.point("front_velocity", "u_n", "discrete", t, recursion.now().velocity);
    }
  }
}

void add_energy(Predictions& table, const theory::WetShock<double>& shock, double until, bool lattice) {
  const auto up_to = [&](double progress) {
    return shock.loss > 0 ? std::min(until, progress / theory::wet_progress(shock, 1.0)) : until;
  };
  const theory::WetFront<double> front(shock);
  for (int k = 0; k <= curve_points; ++k) {
    const double t = curve_time(up_to(last_progress), k);
    const auto here = front.at_time(t);
    if (!here || here->collisions > static_cast<double>(shock.particles / 2)) break;  // stuck, or through the other row
    table.point("energy", "E_loss K(s)", "continuous", t, theory::energy(shock, t));
  }

  const double end = up_to(sticking_progress);
  if (!lattice || theory::wet_collisions(shock, end) > most_collisions) return;
  std::vector<std::uint64_t> counts(curve_points + 1);  // by the first point of the curve that includes the collision
  const auto stuck = theory::cross_rows(shock, end, [&](double time, int pairs) {
    const auto place = static_cast<std::size_t>(std::ceil(time / end * curve_points));
    counts[std::min<std::size_t>(place, curve_points)] += static_cast<std::uint64_t>(pairs);
  });
  table.time("first_sticking_time", "pairs (i,j)", "discrete", stuck);
  std::uint64_t collisions = 0;
  for (int k = 0; k <= curve_points; ++k) {
    const double t = curve_time(end, k);
    if (stuck && t >= *stuck) break;
    collisions += counts[static_cast<std::size_t>(k)];
    table.point("energy", "E_loss K(i,j)", "discrete", t,
                theory::initial_energy(shock) - shock.loss * static_cast<double>(collisions));
  }
}

void add_zone(Predictions& table, const theory::WetShock<double>& shock) {
  if (!(shock.loss > 0) || shock.critical_speed() > shock.speed) return;  // the rows stick before they slow down
  const theory::WetZone<double> zone(shock);
  table.number("density_excess", "(12) = (13)", "continuous", zone.excess());
  table.number("zone_width", "(13)", "continuous", zone.width());
  table.number("collisions_to_rest", "j*", "continuous", theory::collisions_to_rest(shock));
  table.number("speed_lost_per_collision", "before (13)", "continuous", theory::zone_speed_lost(shock));
  table.number("speed_lost_per_collision", "before (13)", "printed", shock.loss / (shock.speed * shock.speed));
  table.number("outer_force", "(15)", "continuous", zone.row_force());
  table.number("outer_force", "(15)", "printed", zone.row_force_printed());
  table.number("inner_force_at_edge", "(14)", "continuous", zone.inner_force(zone.half_width()));
  const theory::OscillationExponents exponents;
  table.number("amplitude_exponent", "(17)", "continuous", exponents.amplitude);
  table.number("frequency_exponent", "(17)", "continuous", exponents.frequency);
  table.number("speed_exponent", "(17)", "continuous", exponents.speed);
  table.number("energy_exponent", "(17)", "continuous", exponents.energy);
}

}  // namespace

void predict_wet(const Scene& scene, Predictions& table) {
  if (unequal_masses(scene)) return;
  const double loss = scene.law.loss.value;
  table.number("critical_closing_speed", "section II", "continuous", theory::critical_closing_speed(loss, 1.0, 1.0));
  table.number("critical_closing_speed", "section II", "printed",
               theory::critical_closing_speed_printed(loss, 1.0, 1.0));
  const bool clusters = scene.initial.type == InitialType::clusters;
  if (!equal_rows(scene) && !clusters) return;

  theory::WetShock<double> shock{loss, scene.initial.speed.value, scene.initial.spacing.value};
  shock.particles = scene.initial.particles;
  add_zone(table, shock);
  if (clusters) return;
  const double until = span(scene);
  table.number("initial_energy", "N m u0^2/2", "continuous", theory::initial_energy(shock));
  const bool lattice = scene.initial.positions == Positions::lattice;
  add_front(table, shock, until, lattice);
  add_energy(table, shock, until, lattice);
  theory::InelasticShock<double> sticky{0, shock.speed, shock.spacing, shock.mass, shock.particles};
  for (int k = 0; k <= curve_points; ++k)
    table.point("energy_sticky", "section VI", "continuous", curve_time(until, k),
                theory::sticky_energy(sticky, curve_time(until, k)));
}

}  // namespace cradle::tools
