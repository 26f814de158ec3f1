// Which points a parameter sweep visits: what the command line or the table [sweep] of a scene says about it, as keys
// and values.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// What is set at a point: keys and values as `--set` takes them.
using SweepPoint = std::vector<std::pair<std::string, std::string>>;

/// The points of a sweep, in order: those given one by one, then all combinations of the varied keys, the last one
/// varying fastest, or (cuts) one key after the other. A key is varied by KEY=FROM:TO:COUNT, evenly, both ends
/// included, KEY=FROM:TO:COUNT:log, evenly in the logarithm, or KEY=VALUE,VALUE,... Throws Error naming what cannot be
/// read, and for more points than `most`, before it takes memory for them.
std::vector<SweepPoint> sweep_points(const Sweep& sweep, double most = 1e6);

/// Keys and values as one text: "law.loss=0.1 initial.seed=2".
std::string point_label(const SweepPoint& point);

/// A finite number, where the text is one and nothing else.
std::optional<double> to_number(const std::string& text);

}  // namespace cradle::tools
