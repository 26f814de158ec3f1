// The points of a parameter sweep, as keys and values, read from the command line or from the table [sweep] of a scene.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// The settings of a point: keys and values as `--set` takes them.
using SweepPoint = std::vector<std::pair<std::string, std::string>>;

/// The points of a sweep, in order. First those given one by one; then all combinations of the varied keys, the last
/// key varying fastest, or (cuts) one key varied at a time. A key is varied by KEY=FROM:TO:COUNT (even steps, both ends
/// included), KEY=FROM:TO:COUNT:log (even in the logarithm), or KEY=VALUE,VALUE,... Throws Error naming what cannot be
/// read. Throws Error for more points than `most`, before allocating them.
std::vector<SweepPoint> sweep_points(const Sweep& sweep, double most = 1e6);

/// Keys and values as one text: "law.loss=0.1 initial.seed=2".
std::string point_label(const SweepPoint& point);

/// The number, if the text is a finite number and nothing else.
std::optional<double> to_number(const std::string& text);

}  // namespace cradle::tools
