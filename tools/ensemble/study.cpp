#include "cradle/tools/ensemble/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/initial/rows.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/run_files.hpp"
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

JournalHeader header_in(const Result& result, const std::string& file, const char* otherwise) {
  const auto& of_file = result.attributes;
  const auto* kind = find_attribute<std::string>(of_file, "kind");
  if (kind == nullptr ? find_attribute<std::uint64_t>(of_file, "identity") == nullptr
                      : *kind != "ensemble" && *kind != "sweep")
    throw Error({file}, "holds no ensemble",
                kind == nullptr ? "a single run, or another command's result" : "a result of " + *kind, otherwise);
  JournalHeader header{attribute<std::string>(of_file, "kind", file),
                       attribute<std::uint64_t>(of_file, "identity", file),
                       attribute<std::string>(of_file, "scene", file), attribute<std::string>(of_file, "name", file)};
  const std::string spread = "ensemble/spread/", below = "/ensemble";
  for (const Group& group : result.groups) {
    const auto& here = group.attributes;
    if (group.name == "ensemble") {
      header.points.emplace_back("", header.scene);
    } else if (group.name.starts_with("points/") && group.name.ends_with(below)) {
      header.points.emplace_back(group.name.substr(0, group.name.size() - below.size()),
                                 attribute<std::string>(here, "scene", file));
    } else if (group.name.starts_with(spread) && !group.columns.empty()) {
      header.spreads.push_back({group.name.substr(spread.size()),
                                {attribute<double>(here, "from", file), attribute<double>(here, "to", file),
                                 attribute<std::uint64_t>(here, "bins", file)}});
      if (const SpreadRequest& found = header.spreads.back(); !found.bins_are_possible())
        throw Error({file, 0, group.name}, "no bins", fmt::format("{}", found.bins.bins), "make the file anew",
                    Exit::io);
    }
  }
  return header;
}

Study study_in(const JournalHeader& header, const std::string& path, const Error& of_other_scenes) {
  Study study{header.kind, scene_of(header, path), {}, header.spreads};
  for (const auto& [group, scene] : header.points) {
    study.points.push_back({group, parse_scene(scene, path)});
    study.points.back().scene.name = header.name;
  }
  if (study.identity() != header.identity) throw of_other_scenes;
  // The identity is that of the points, not of the scene that is varied.
  if (const std::size_t n = study.points.size(); study.kind == "sweep" && sweep_points(study.scene.sweep).size() != n)
    throw Error({path}, "a sweep with other points than its scene", fmt::format("{} points", n),
                "make it anew, or remove it", Exit::io);
  return study;
}

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
