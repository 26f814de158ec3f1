#include "cradle/tools/ensemble/sweep.hpp"

#include <fmt/format.h>

#include "cradle/tools/ensemble/sweep_summary.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

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

Study sweep_in(const Result& result, const std::string& file) {
  return sweep_at(scene_in(result.attributes, file), [&](const std::string& group) {
    const Group* ensemble = result.find(group + "/ensemble");
    if (ensemble == nullptr)
      throw Error({file, 0, ""}, "a sweep without one of its points", group, "make the file anew", Exit::io);
    return scene_in(ensemble->attributes, file);
  });
}

}  // namespace cradle::tools
