// One run of a scene: initial state, engine, observers, result.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/engines/precision.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/ends.hpp"
#include "cradle/tools/run/sink.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

class RunObserver;

struct RunOptions {
  Progress::Show progress = Progress::Show::on_terminal;
  RunObserver* observer = nullptr;  // gets every collision and every sample
  Interrupt* interrupt = nullptr;   // says whether to stop; heeded once there is something to keep
  Workers workers = {};             // for a run that is cut into segments
  std::string announcement = {};    // for standard error, once it is known that the run can begin
  bool held = false;                // by a caller who may observe collisions, or ask for a number of them
  std::function<double(double)> restitution = {};  // of the closing speed, instead of the scene's law; in double only
};

struct RunOutcome {
  Result result;  // of a run into memory
  RunEnd end = RunEnd::reached;
  std::string report;                        // of a collapse, for standard output; else empty
  std::string warning;                       // what was not resolved, for standard error; else empty
  std::string collapse_time;                 // where the run stopped at a collapse
  std::optional<double> collapsed_at;        // the same, rounded
  std::uint64_t collisions = 0, merges = 0;  // at the end, like time and energy
  double time = 0, energy = 0;
  double energy_digits = 10;                            // digits of the energy that rounding leaves right, ...
  bool may_have_grown = false;                          // ... unless it has grown, which nothing has followed
  double seconds = 0;                                   // of computing
  std::vector<std::pair<std::string, double>> summary;  // numbers of the whole run, by name: columns of /replicas
};

/// Where a result is from, for its attributes: versions, the effective scene, its name and precision, how it ended.
std::vector<Attribute> provenance(const Scene& scene, const std::string& precision, std::string_view outcome);

/// The scene stored in a result. Throws Error (Exit::io) naming the file.
Scene scene_in(const std::vector<Attribute>& attributes, const std::string& file);

/// Throws Error, naming the key, for a scene that this build or its precision cannot run; sets the digits.
void check_built(const Scene& scene);

/// The scene without tables that are only written: it makes the same collisions, and its series is the same.
Scene without_tables(Scene scene);

/// Runs the scene in its precision, coordinates and law, into a sink. Throws Error for what this build cannot do.
RunOutcome run_scene(const Scene& scene, const RunOptions& options, Sink& sink);
/// The same into memory: the outcome has the result.
RunOutcome run_scene(const Scene& scene, const RunOptions& options);
/// The same of a scene with initial.type = "clusters" (clusters.cpp). Throws Error if collisions are requested (trust).
RunOutcome run_clusters(const Scene& scene, const RunOptions& options, Sink& sink);

}  // namespace cradle::tools
