// A parameter sweep: variations of a scene, one ensemble each, all in one file with a table of their results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/study.hpp"

namespace cradle::tools {

/// The study of a scene at these points; a point is set after `overrides`. Throws Error, naming the point, if its scene
/// is not valid.
///
/// In the file: `/sweep` has a column for every key that takes numbers (named as the key; NaN at points that do not set
/// it), `label`s as attributes, and for every number of the replicas (collisions, energy, ...) its mean and the
/// standard error of the mean (`_error`). `/points/0000` and so on are the ensembles.
Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep);

/// The study of a scene that names its points; `scene_at` gives the scene of each group in the file.
Study sweep_at(const Scene& scene, const std::function<Scene(const std::string& group)>& scene_at);

}  // namespace cradle::tools
