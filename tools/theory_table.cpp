#include "cradle/tools/theory_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"

namespace cradle::tools {

namespace {

constexpr int curve_points = 400;

void add_curves(std::vector<Prediction>& table, const theory::InelasticShock<double>& shock, double until) {
  // The front is traced until it has turned; (7) a little beyond, where it departs from the run.
  const double turnover = theory::turnover_time(shock).value_or(until);
  for (int k = 0; k <= curve_points; ++k) {
    const double t = std::min(until, 2 * turnover) * k / curve_points;
    table.push_back({"front_position", "(5)", "continuous", t, theory::front_position(shock, t)});
    table.push_back({"front_velocity", "(4)", "continuous", t, theory::front_velocity(shock, t)});
    table.push_back({"front_position", "x_n, t_n", "discrete", t, theory::front_position_discrete(shock, t)});
    if (k > 0) {
      table.push_back({"interaction_density", "before (6)", "continuous", t, theory::interaction_density(shock, t)});
      table.push_back({"mean_velocity_slope", "(6), line 1", "continuous", t, theory::mean_velocity_slope(shock, t)});
      table.push_back(
          {"mean_velocity_slope", "(6), line 1", "printed", t, theory::mean_velocity_slope(shock, t) / shock.speed});
    }
    const double energy = theory::energy(shock, t);
    table.push_back({"energy", "(7)", "continuous", t, energy});
    table.push_back({"energy", "(7)", "printed", t, 2 * theory::initial_energy(shock) - energy});
  }
  for (int k = 0; k <= curve_points; ++k) {
    const double t = until * k / curve_points;
    table.push_back({"energy_sticky", "section IV", "continuous", t, theory::sticky_energy(shock, t)});
  }
}

}  // namespace

std::vector<Prediction> predictions(const Scene& scene) {
  if (scene.law.type != LawType::inelastic)
    throw Error({scene.name, 0, "law.type"}, "no predictions for this law yet", "wet or sticky",
                "give an inelastic scene");
  const double eps = scene.law.restitution.value, start = scene.run.start.value;
  std::vector<Prediction> table;
  const auto number = [&](const char* quantity, const char* equation, const char* form, std::optional<double> value) {
    if (value) table.push_back({quantity, equation, form, std::nullopt, *value});
  };
  number("three_body_collapse_limit", "7 - 4 sqrt 3", "continuous", theory::three_body_collapse_limit<double>());
  if (eps < 1) number("collapse_onset_bodies", "N_c", "continuous", theory::collapse_onset_bodies(eps));
  if (scene.initial.type != InitialType::rows || scene.initial.general_rows()) return table;

  theory::InelasticShock<double> shock{eps};
  shock.speed = scene.initial.speed.value;
  shock.spacing = scene.initial.spacing.value;
  shock.particles = scene.initial.particles;
  number("initial_energy", "N m u0^2/2", "continuous", theory::initial_energy(shock));
  number("turnover_time", "(4) = 0", "continuous", theory::turnover_time(shock));
  number("maximal_front", "x_max", "continuous", theory::maximal_front(shock));
  if (const auto turned = theory::turnover_contact(shock)) {
    number("turnover_time", "t_n", "discrete", turned->time);
    number("maximal_front", "max(x_n - x_0)", "discrete", turned->position - shock.origin());
  }
  number("mean_velocity_slope", "(6), line 2", "continuous", theory::mean_velocity_slope_early(shock));
  if (eps < 1) number("collapse_onset_time", "N_c/(2 u0)", "continuous", theory::collapse_onset_time(shock));
  add_curves(table, shock, scene.run.until.value - start);
  return table;
}

std::string predictions_csv(const std::vector<Prediction>& table) {
  std::string csv = "quantity,equation,form,t,value\n";
  for (const auto& p : table) {
    const auto quoted = [](const std::string& s) { return s.find(',') == std::string::npos ? s : '"' + s + '"'; };
    csv += fmt::format("{},{},{},{},{}\n", p.quantity, quoted(p.equation), p.form, p.t ? fmt::format("{}", *p.t) : "",
                       p.value);
  }
  return csv;
}

}  // namespace cradle::tools
