// One run of a scene: initial state, engine, observers, result.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/model/ends.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run_observer.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/run_store.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

/// Of a run that the engine has ended so; `order_lost`: by its account.
RunEnd end_of(Status status, bool order_lost);

struct RunOptions {
  Progress::Show progress = Progress::Show::on_terminal;
  RunObserver* observer = nullptr;  // is notified of every collision
  Interrupt* interrupt = nullptr;   // polled now and then whether to stop; heeded once there is something to keep
  Workers workers = {};             // for a run that is cut into segments
  RunStore* store = nullptr;        // puts what is recorded where it is safe; without one it comes back in the result
};

struct RunOutcome {
  Result result;  // without the rows that a keeper has
  RunEnd end = RunEnd::reached;
  std::string report;                        // of a collapse, for standard output; else empty
  std::string warning;                       // what was not resolved, for standard error; else empty
  std::string collapse_time;                 // where the run stopped at a collapse
  std::uint64_t collisions = 0, merges = 0;  // at the end, as are time and energy
  double time = 0, energy = 0;
  double energy_digits = 10;  // of those that the energy is given with, as rounding leaves them
  std::vector<std::pair<std::string, double>> summary;  // numbers of the whole run, by name: columns of /replicas
};

/// "double", "mpfr, 50 digits", ...
std::string precision_name(const Run& run);

/// What every result says of where it is from: versions, the effective scene, its name and precision, how it ended.
std::vector<Attribute> provenance(const Scene& scene, const std::string& precision, std::string_view outcome);

/// The scene that a result is from, as it stands there. Throws Error (Exit::io) naming the file.
Scene scene_in(const std::vector<Attribute>& attributes, const std::string& file);

/// Throws Error for a scene that this build cannot run, naming the key.
void check_built(const Scene& scene);

/// The times at which a run samples its series, takes its profiles and ends, as it writes them: rounded from its
/// precision.
struct PlannedTimes {
  std::vector<double> series, profiles;
  double until = 0;
};
PlannedTimes planned_times(const Scene& scene);

/// Runs the scene in its precision, coordinates and law. Throws Error for what this build cannot do.
RunOutcome run_scene(const Scene& scene, const RunOptions& options);

}  // namespace cradle::tools
