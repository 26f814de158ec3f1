#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

std::vector<std::string> CommonOptions::all_overrides() const {
  std::vector<std::string> all = overrides;
  if (seed) all.push_back("initial.seed=" + *seed);
  return all;
}

Scene CommonOptions::read() const { return read_scene(scene, all_overrides()); }

void add_common_options(Command& command, CommonOptions& options) {
  command.argument("SCENE", options.scene, "scene file, or the name of a bundled scene");
  command.repeated("--set", options.overrides, "table.key=value instead of what the scene says; may be repeated",
                   "KEY=VALUE");
  command.option("--seed", options.seed, "instead of initial.seed");
  add_running_options(command, options);
}

void add_running_options(Command& command, RunningOptions& options) {
  command.option("--threads", options.threads,
                 "threads to use at most, for replicas or for one run of many particles; 0: all processors; never "
                 "changes a result");
  command.flag("--quiet", options.quiet, "no messages but errors and the collapse report");
  command.flag("--progress", options.progress, "report progress also where standard error is not a terminal");
}

}  // namespace cradle::tools
