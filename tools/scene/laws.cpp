#include "cradle/tools/scene/laws.hpp"

namespace cradle::tools {

namespace {

constexpr LawRow laws[] = {
    {.type = LawType::inelastic, .merges = false, .needs_events = true, .policies = true, .provable = true},
    {.type = LawType::wet, .merges = true, .needs_events = true, .policies = false, .provable = true},
    {.type = LawType::sticky, .merges = true, .needs_events = false, .policies = false, .provable = true},
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
