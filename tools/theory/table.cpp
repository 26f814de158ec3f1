#include "cradle/tools/theory/table.hpp"

#include <fmt/format.h>

#include <utility>

#include "cradle/tools/theory/laws.hpp"

namespace cradle::tools {

std::vector<Prediction> predictions(const Scene& scene) {
  Predictions table;
  if (scene.walls.any() || scene.gravity.acts()) return {};  // the paper has none
  if (const auto predict = law_theory(scene).predict) predict(scene, table);
  if (scene.initial.type == InitialType::ring && !unequal_masses(scene)) predict_cooling(scene, table);
  return std::move(table).take();
}

std::string misprints(const Scene& scene) { return std::string(law_theory(scene).misprints); }

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
