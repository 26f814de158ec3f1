#include "cradle/tools/ensemble/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cradle/tools/ensemble/sweep_points.hpp"
#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

// Columns of numbers, one row per point, added in the order of first use; NaN if a point has no value.
struct Table {
  void put(std::size_t point, const std::string& name, const std::string& unit, const std::string& description,
           double value) {
    auto at = std::ranges::find(columns, name, &Column::name);
    if (at == columns.end()) at = columns.insert(at, {name, unit, description, std::vector<double>(points, missing)});
    std::get<std::vector<double>>(at->values)[point] = value;
  }

  std::size_t points;
  std::vector<Column> columns = {};
};

// Adds in the order of the replicas' indices, so that the bits do not depend on the order of computing.
void put_mean(Table& table, std::size_t point, const Column& about, const std::vector<double>& values) {
  double n = 0, mean = 0, squares = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    n += 1;
    const double before = value - mean;
    mean += before / n;
    squares += before * (value - mean);
  }
  table.put(point, about.name, about.unit, "mean over replicas: " + about.description, n > 0 ? mean : missing);
  table.put(point, about.name + "_error", about.unit, "standard error of that mean",
            n > 1 ? std::sqrt(squares / (n * (n - 1))) : missing);
  table.put(point, about.name + "_replicas", "1", "replicas that have this number", n);
}

// `/sweep`: what was varied, how many replicas ended, and means over them with standard errors; a row per point.
Group sweep_summary(const std::vector<SweepPoint>& points, const EnsembleStates& states) {
  Table table{points.size()};
  Group group{"sweep", {}, {}};
  for (std::size_t p = 0; p < points.size(); ++p) {
    group.attributes.emplace_back(fmt::format("label_{:04}", p), point_label(points[p]));
    for (const auto& [key, value] : points[p])
      if (const auto number = to_number(value)) table.put(p, key, "", "varied", *number);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    const EnsembleState& state = *states[p];
    const auto& replicas = state.table();
    table.put(p, "replicas", "1", "replicas that ended", static_cast<double>(replicas.size()));
    table.put(p, "failed", "1", "replicas that failed, lost the order of collisions or exhausted the resolution",
              static_cast<double>(state.failures().size()));
    const auto order = replicas.order();
    const auto mean = [&](const Column& about, auto of) {
      std::vector<double> values;
      for (const std::size_t k : order) values.push_back(static_cast<double>(std::invoke(of, replicas, k)));
      put_mean(table, p, about, values);
    };
    mean({"collisions", "1", "collisions", {}}, &ReplicaTable::collisions);
    mean({"merges", "1", "merges", {}}, &ReplicaTable::merges);
    const auto& numbers = state.layout().numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      mean(numbers[i], [i](const ReplicaTable& all, std::size_t k) { return all.number(k, i); });
  }
  group.columns = std::move(table.columns);
  return group;
}

// The study of a scene that names the sweep; scene_at(point) gives the scene of each point.
template <class SceneAt> Study study_of(Scene scene, SceneAt scene_at) {
  const auto points = sweep_points(scene.sweep);
  Study study;
  study.kind = "sweep";
  study.scene = std::move(scene);
  study.scene.sweep.replicas = 1;  // the number of replicas is not part of the study
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::string group = fmt::format("points/{:04}", p);
    study.points.push_back({group, scene_at(points[p], group)});
  }
  study.summary = [points](const EnsembleStates& states) { return std::vector<Group>{sweep_summary(points, states)}; };
  return study;
}

}  // namespace

Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep) {
  Scene varied = read_scene(scene, overrides);
  varied.sweep = sweep;
  const auto points = sweep_points(sweep);
  for (const std::string& given : overrides) {
    const std::string key = key_of(given);
    const auto sets = [&](const SweepPoint& point) {
      return std::ranges::find(point, key, &SweepPoint::value_type::first) != point.end();
    };
    if (std::ranges::all_of(points, sets))
      throw Error({"--set", 0, key}, "every point of the sweep sets it too", given, "leave out one of the two");
  }
  return study_of(std::move(varied), [&](const SweepPoint& point, const std::string&) {
    std::vector<std::string> all = overrides;
    for (const auto& [key, value] : point) all.push_back(key + "=" + value);
    Scene at = read_scene(scene, all);
    at.sweep = {};
    at.sweep.replicas = 1;
    return at;
  });
}

Study sweep_at(const Scene& scene, const std::function<Scene(const std::string& group)>& scene_at) {
  return study_of(scene, [&](const SweepPoint&, const std::string& group) {
    Scene at = scene_at(group);
    at.name = scene.name;
    return at;
  });
}

}  // namespace cradle::tools
