#include "cradle/tools/theory/table.hpp"

#include <fmt/format.h>

#include <utility>

#include "cradle/tools/theory/laws.hpp"

namespace cradle::tools {

std::vector<Prediction> predictions(const Scene& scene) {
  Predictions table;
  if (scene.walls.any()) return {};  // the paper has none
  switch (scene.law.type) {
  case LawType::inelastic:
    predict_inelastic(scene, table);
    break;
  case LawType::wet:
    predict_wet(scene, table);
    break;
  case LawType::sticky:
    predict_sticky(scene, table);
    break;
  }
  if (scene.initial.type == InitialType::ring && !unequal_masses(scene)) predict_cooling(scene, table);
  return std::move(table).take();
}

std::string misprints(const Scene& scene) {
  switch (scene.law.type) {
  case LawType::inelastic:
    return "(6), first line, lacks a factor u0; (7) must carry a plus sign.";
  case LawType::wet:
    return "bodies stick below sqrt(2 E_loss/mu), not sqrt(2 E_loss)/mu;\n"
           "  before (13) the speed lost is E_loss/(m u0), not E_loss/(m u0^2);\n"
           "  before (14) the momentum lacks a factor m;\n"
           "  (15): F_+ is 0 for x >= L and the force of a whole row, about n0 E_loss, for x <= -L; F_- mirrors it;\n"
           "  (17) is right for M x'', not for d(M x')/dt.";
  case LawType::sticky:
    break;
  }
  return "";
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
