// A parameter sweep: variations of a scene, one ensemble each, all in one file with a table of their results. Its
// points are keys and values, from the command line or from the table [sweep] of a scene.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/ensemble/study.hpp"

namespace cradle::tools {

/// The settings of a point, as `--set` takes them: "law.loss=0.1".
using SweepPoint = std::vector<std::string>;

/// The points of a sweep, in order. First those given one by one; then all combinations of the varied keys, the last
/// key varying fastest, or (cuts) one key varied at a time. A key is varied by KEY=FROM:TO:COUNT (even steps, both ends
/// included), KEY=FROM:TO:COUNT:log (even in the logarithm), or KEY=VALUE,VALUE,... Throws Error naming what cannot be
/// read. Throws Error for more points than `most`, before allocating them.
std::vector<SweepPoint> sweep_points(const Sweep& sweep, double most = 1e6);

/// The number, if the text is a finite number and nothing else.
std::optional<double> to_number(const std::string& text);

/// The study of a scene at these points; a point is set after `overrides`. Throws Error, naming the point, if its scene
/// is not valid.
///
/// In the file `/points/0000` and so on are the ensembles.
Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep);

/// `/sweep`, a row per point: a column for every key that takes numbers (named as the key; NaN at points that do not
/// set it), `label`s as attributes, how many replicas ended, and for every number of the replicas (collisions, energy,
/// ...) its mean and the standard error of the mean (`_error`).
Group sweep_summary(const Sweep& sweep, const EnsembleStates& states);

}  // namespace cradle::tools
