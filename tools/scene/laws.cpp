#include "cradle/tools/scene/laws.hpp"

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

const LawRow& law_row(const Scene& scene) { return law_rows[static_cast<std::size_t>(scene.law.type)]; }

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
