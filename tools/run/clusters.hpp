// Runs a scene with initial.type = "clusters": the paper's model of the two heaviest clusters, equation (16),
// integrated in double. It has no particles.
#pragma once

#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// The result has the layout of any run (series, series/heaviest), and also the force (14) over twice the width of the
/// zone and a table of the meetings of the clusters. Throws Error if collisions are requested (trust): there are none.
RunOutcome run_clusters(const Scene& scene, const RunOptions& options, Sink& sink);

}  // namespace cradle::tools
