// The results of a sweep in one table, a row per point.
#pragma once

#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/ensemble/sweep_points.hpp"

namespace cradle::tools {

/// `/sweep`: what was varied, how many replicas ended, and means over them with standard errors.
Group sweep_summary(const std::vector<SweepPoint>& points, const EnsembleStates& states);

}  // namespace cradle::tools
