#include "cradle/tools/ensemble/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/initial/rows.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

// Whether replicas differ: by velocities, displacements (whole multiples of a unit, core/initial/rows.hpp), masses or
// walls. What an initial state does not have is 0 in its scenes.
bool is_random(const Scene& scene) {
  const Initial& initial = scene.initial;
  return initial.variance > Decimal("0") || initial.hot > 1 || initial.positions != Positions::lattice ||
         initial.perturbation.value * static_cast<double>(displacement_unit) >= 1 || !initial.random_masses.empty() ||
         scene.walls.left.temperature || scene.walls.right.temperature;
}

}  // namespace

std::string same_replicas_warning(const Study& study, std::uint64_t replicas) {
  if (replicas < 2) return "";
  std::string points;
  bool listed = false;
  for (const auto& [group, scene] : study.points)
    if (!is_random(scene)) {
      points += (points.empty() ? "" : ", ") + (group.empty() ? scene.name : group);
      listed = listed || scene.initial.type == InitialType::list;
    }
  if (points.empty()) return "";
  return fmt::format("nothing is random in {}: all {} replicas are the same run; give {}--replicas 1\n", points,
                     replicas, listed ? "" : "initial.perturbation, or ");
}

std::uint64_t Study::identity() const {
  std::string all = to_bytes(std::string(version)) + to_bytes(kind);
  for (const Point& point : points) all += to_bytes(std::pair(point.group, effective_toml(point.scene)));
  for (const SpreadRequest& spread : spreads) all += to_bytes(spread);
  return crc64(all);
}

Study ensemble_of(const Scene& scene, std::vector<SpreadRequest> spreads) {
  for (SpreadRequest& spread : spreads)
    if (!spread.name.starts_with("series/") && !spread.name.starts_with("profiles/") &&
        !spread.name.starts_with("zone/"))
      spread.name = "series/" + spread.name;
  std::sort(spreads.begin(), spreads.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return {.scene = scene, .points = {{"", scene}}, .spreads = std::move(spreads)};
}

std::uint64_t replicas_in(const EnsembleStates& states) {
  std::uint64_t sum = 0;
  for (const auto& state : states) sum += state->replicas().size();
  return sum;
}

}  // namespace cradle::tools
