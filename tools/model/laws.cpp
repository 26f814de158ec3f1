#include "cradle/tools/model/laws.hpp"

#include "cradle/tools/theory/cost.hpp"
#include "cradle/tools/theory/laws.hpp"

namespace cradle::tools {

namespace {

constexpr LawRow laws[] = {
    {.type = LawType::inelastic,
     .merges = false,
     .needs_events = true,
     .policies = true,
     .provable = true,
     .predict = predict_inelastic,
     .cost_of_rows = bouncing_rows,
     .misprints = "(6), first line, lacks a factor u0; (7) must carry a plus sign."},
    {.type = LawType::wet,
     .merges = true,
     .needs_events = true,
     .policies = false,
     .provable = true,
     .predict = predict_wet,
     .cost_of_rows = wet_rows,
     .misprints =
         "particles stick below sqrt(2 E_loss/mu), not sqrt(2 E_loss)/mu;\n"
         "  before (13) the speed lost is E_loss/(m u0), not E_loss/(m u0^2);\n"
         "  before (14) the momentum lacks a factor m;\n"
         "  (15): F_+ is 0 for x >= L and the force of a whole row, about n0 E_loss, for x <= -L; F_- mirrors it;\n"
         "  (17) is right for M x'', not for d(M x')/dt."},
    {.type = LawType::sticky,
     .merges = true,
     .needs_events = false,
     .policies = false,
     .provable = true,
     .predict = predict_sticky,
     .cost_of_rows = sticky_rows,
     .misprints = ""},
};

constexpr bool laws_in_order() {
  for (const LawRow& row : laws)
    if (&laws[static_cast<std::size_t>(row.type)] != &row) return false;
  return true;
}
static_assert(laws_in_order());

}  // namespace

const LawRow& law_row(const Scene& scene) { return laws[static_cast<std::size_t>(scene.law.type)]; }

bool particles_merge(const Scene& scene) {
  return law_row(scene).merges || scene.run.collapse == scene::CollapsePolicy::merge;
}

bool stops_at_collapse(const Scene& scene) {
  return !law_row(scene).merges && scene.run.collapse == scene::CollapsePolicy::stop;
}

bool without_collisions(const Scene& scene) {
  return !law_row(scene).needs_events && !scene.output.observes_collisions();
}

}  // namespace cradle::tools
