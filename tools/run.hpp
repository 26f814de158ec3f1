// One run of a scene: initial state, engine, observers, result.
#pragma once

#include <string>

#include "cradle/tools/errors.hpp"
#include "cradle/tools/progress.hpp"
#include "cradle/tools/result.hpp"
#include "cradle/tools/scene.hpp"

namespace cradle::tools {

struct RunOutcome {
  Result result;
  Exit status = Exit::done;
  std::string report;   // of a collapse, for standard output; else empty
  std::string warning;  // what was not resolved, for standard error; else empty
};

/// "double", "mpfr, 50 digits", ...
std::string precision_name(const Run& run);

/// Throws Error for a scene that this build cannot run, naming the key.
void check_built(const Scene& scene);

/// Runs the scene in its precision, coordinates and law. Throws Error for what this build cannot do.
RunOutcome run_scene(const Scene& scene, Progress::Show progress);

}  // namespace cradle::tools
