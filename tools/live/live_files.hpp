// The files of a run that its caller holds (tools/run/live_run.hpp): checkpoints, and the result at its end.
#pragma once

#include <memory>
#include <string>

#include "cradle/tools/run/live_run.hpp"
#include "cradle/tools/store/overwrite.hpp"

namespace cradle::tools {

/// Writes a file from which `load_live_run` continues. Throws Error, also if the run is over.
void save_live_run(LiveRun& run, const std::string& path);
std::unique_ptr<LiveRun> load_live_run(const std::string& path, const LiveOptions& options);
/// Writes the result of a run that is over. It replaces only what `cradle run` would replace. Throws Error.
void write_live_run(LiveRun& run, const std::string& path, Force force);

}  // namespace cradle::tools
