#include "cradle/tools/scene/scene.hpp"

#include <algorithm>

#include "cradle/tools/scene/checks.hpp"

namespace cradle::tools {

bool Output::has_histogram(std::string_view name) const {
  return std::ranges::find(histograms, name) != histograms.end();
}

bool Output::observes_collisions() const {
  const auto of_collisions = [](const std::string& name) { return name != "gap" && name != "cluster"; };
  return events || word || std::ranges::any_of(histograms, of_collisions);
}

const LawRow& law_row(const Scene& scene) { return law_rows[static_cast<std::size_t>(scene.law.type)]; }

const InitialRow& initial_row(const Scene& scene) { return initial_rows[static_cast<std::size_t>(scene.initial.type)]; }

bool particles_merge(const Scene& scene) {
  return law_row(scene).merges || scene.run.collapse == scene::CollapsePolicy::merge;
}

bool stops_at_collapse(const Scene& scene) {
  return !law_row(scene).merges && scene.run.collapse == scene::CollapsePolicy::stop;
}

bool without_collisions(const Scene& scene) {
  return !law_row(scene).needs_events && !scene.output.observes_collisions();
}

bool unequal_masses(const Scene& scene) {
  return !scene.initial.random_masses.empty() ||
         std::ranges::any_of(scene.initial.masses, [](const Decimal& mass) { return mass != Decimal("1"); });
}

std::optional<std::pair<Decimal, Decimal>> extent(const Scene& scene) {
  const auto& [left, right] = scene.walls;
  if (scene.initial.on_ring()) return std::pair(Decimal("0"), scene.initial.length);
  if (!left.position || !right.position || left.speed != Decimal("0") || right.speed != left.speed) return {};
  return std::pair(*left.position, *right.position);
}

std::string collapsing_floor(const Scene& scene) {
  const auto collapses = [&](const WallAt& wall, bool floor) { return wall.dissipates() && (floor || wall.shaken()); };
  const auto& [left, right] = scene.walls;
  const bool acts = scene.gravity.acts(), to_left = acts && *scene.gravity.acceleration < Decimal("0");
  if (left.shaken() && right.shaken() && left.position && right.position) return "";  // between which none can rest
  if (collapses(right, acts && !to_left) && !(to_left && collapses(left, true))) return "walls.right";
  return collapses(left, to_left) ? "walls.left" : "";
}

bool operator==(const Scene& a, const Scene& b) {
  return std::ranges::all_of(scene_fields(), [&](const Field& field) { return same_value(field, a, b); });
}

Place Scene::place(std::string_view key) const {
  const std::string table = std::string(key) + ".";
  Place found{name, 0, std::string(key)};
  for (const auto& [given, at] : places)
    if ((given == key || given.starts_with(table)) && (found.line == 0 || (0 < at.line && at.line < found.line)))
      found.source = at.source, found.line = at.line;
  return found;
}

std::uint64_t longest_lag(const Scene& scene) {
  const Correlations& wanted = scene.output.correlations;
  bin_float span = precise(wanted.until) - precise(wanted.from);
  if (wanted.longest && precise(*wanted.longest) < span) span = precise(*wanted.longest);
  // Rounding to a double makes a quotient of decimals whole that is so.
  return static_cast<std::uint64_t>(static_cast<double>(bin_float(span / precise(*wanted.every))));
}

}  // namespace cradle::tools
