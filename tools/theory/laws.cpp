#include "cradle/tools/theory/theory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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
