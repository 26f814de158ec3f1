// The sticky shock, section II (Fig. 1), which is also the limit of sections IV and VI: one cluster at the centre
// absorbs all incoming particles.
#include "cradle/core/theory/sticky_shock.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

struct Rows {
  theory::StickyShock<double> shock;
  double left = 0, right = 0;  // mass of either row
  double energy = 0;           // at the start
};

Rows rows_of(const Initial& initial) {
  Rows rows;
  if (initial.general_rows()) {
    const scene::Row &l = initial.left, &r = initial.right;
    const Centre& c = initial.centre;
    rows.shock = {l.density.value, l.speed.value, r.density.value, r.speed.value, c.mass.value, c.speed.value};
    rows.left = static_cast<double>(l.particles);
    rows.right = static_cast<double>(r.particles);
  } else {
    const double density = 1 / initial.spacing.value, speed = initial.speed.value;
    rows.shock = {density, speed, density, -speed};
    rows.left = rows.right = static_cast<double>(initial.particles / 2);
  }
  const auto& s = rows.shock;
  const auto kinetic = [](double mass, double v) { return mass * v * v / 2; };
  rows.energy =
      kinetic(rows.left, s.velocity_left) + kinetic(rows.right, s.velocity_right) + kinetic(s.mass, s.velocity);
  return rows;
}

}  // namespace

void predict_sticky(const Scene& scene, Predictions& table) {
  if (scene.initial.type != InitialType::rows || unequal_masses(scene)) return;
  const Rows rows = rows_of(scene.initial);
  table.number("initial_energy", "sum m u^2/2", "continuous", rows.energy);
  table.number("central_mass_growth", "section II", "continuous", theory::late_growth(rows.shock));
  table.number("central_velocity", "section II", "continuous", theory::late_velocity(rows.shock));
  table.number("energy_loss_rate", "section IV", "continuous", theory::late_power(rows.shock));
  const double until = span(scene);
  for (int k = 0; k <= curve_points; ++k) {
    const double t = curve_time(until, k);
    const auto centre = theory::sticky_centre(rows.shock, t);
    if (centre.from_left > rows.left || centre.from_right > rows.right) break;  // a row has been absorbed
    table.point("central_mass", "section II", "continuous", t, centre.mass);
    table.point("central_position", "section II", "continuous", t, centre.position);
    table.point("central_velocity", "section II", "continuous", t, centre.velocity);
    table.point("energy_sticky", "section IV", "continuous", t, rows.energy - centre.energy_lost);
  }
}

}  // namespace cradle::tools
