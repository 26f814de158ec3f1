// The sample that an observer receives at an output time.
#pragma once

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/run/run_observer.hpp"

namespace cradle::tools {

/// `at_collision`: the run ends at this time, with a collision.
RunSample run_sample(const Scene& scene, const Schedule& plan, const AnyEngine& engine, const RunState& now,
                     bool at_collision);

}  // namespace cradle::tools
