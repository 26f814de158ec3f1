// The run of a scene with initial.type = "clusters": not particles but the paper's model of the two heaviest clusters,
// equation (16), integrated in double.
#pragma once

#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// The layout is that of any run: series, series/heaviest; besides, the force (14) over twice the width of the zone and
/// what happened where the clusters met. Throws Error where collisions are requested (trust), of which there are none.
RunOutcome run_clusters(const Scene& scene, const RunOptions& options);

}  // namespace cradle::tools
