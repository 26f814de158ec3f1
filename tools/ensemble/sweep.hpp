// A parameter sweep: the points that a scene is varied over, each an ensemble of its own in one file, and a table of
// what the points have come to.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/ensemble/sweep_points.hpp"

namespace cradle::tools {

/// The study of a scene at these points, which are set on top of what `overrides` sets. Throws Error for a point that
/// makes no scene, naming it.
///
/// In the file: `/sweep` with a column for every key that takes numbers (named as the key; NaN at points that do not
/// set it), `label`s as attributes, and for every number of the replicas (collisions, energy, ...) its mean over them
/// and the standard error of that (`_error`); `/points/0000` and so on, the ensembles.
Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep);

/// That of a scene which names its points, with the scenes that they are, by their groups in the file.
Study sweep_at(const Scene& scene, const std::function<Scene(const std::string& group)>& scene_at);

/// The sweep that a file holds, its points as they stand there. Throws Error (Exit::io) for a damaged one.
Study sweep_in(const Result& result, const std::string& file);

}  // namespace cradle::tools
