#include "cradle/tools/theory/theory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "cradle/core/theory/free_cooling.hpp"

namespace cradle::tools {

namespace {

constexpr LawTheory laws[] = {
    {.type = LawType::inelastic,
     .predict = predict_inelastic,
     .cost_of_rows = bouncing_rows,
     .misprints = "(6), first line, lacks a factor u0; (7) must carry a plus sign."},
    {.type = LawType::wet,
     .predict = predict_wet,
     .cost_of_rows = wet_rows,
     .misprints =
         "particles stick below sqrt(2 E_loss/mu), not sqrt(2 E_loss)/mu;\n"
         "  before (13) the speed lost is E_loss/(m u0), not E_loss/(m u0^2);\n"
         "  before (14) the momentum lacks a factor m;\n"
         "  (15): F_+ is 0 for x >= L and the force of a whole row, about n0 E_loss, for x <= -L; F_- mirrors it;\n"
         "  (17) is right for M x'', not for d(M x')/dt."},
    {.type = LawType::sticky, .predict = predict_sticky, .cost_of_rows = sticky_rows, .misprints = ""},
};

// Free cooling on a ring: the law that, according to the paper, all three gases follow in the end, and Haff's law for
// the early stage of the inelastic gas. Times are evenly spaced in the logarithm.
void predict_cooling(const Scene& scene, Predictions& table) {
  // The sticky gas is that of infinitely many particles: its curve ends where so many clusters are left.
  constexpr double few = 10;
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

}  // namespace

const LawTheory& law_theory(const Scene& scene) {
  static constexpr LawTheory none{};
  const auto* const row = std::ranges::find(laws, scene.law.type, &LawTheory::type);
  return row == std::end(laws) ? none : *row;
}

std::vector<Prediction> predictions(const Scene& scene) {
  Predictions table(scene.run.start.value);
  if (scene.walls.any() || scene.gravity.acts()) return {};  // the paper has none
  if (const auto predict = law_theory(scene).predict) predict(scene, table);
  if (scene.initial.type == InitialType::ring && !unequal_masses(scene)) predict_cooling(scene, table);
  return std::move(table).take();
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
