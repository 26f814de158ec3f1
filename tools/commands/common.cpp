#include <CLI/CLI.hpp>

#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

std::vector<std::string> CommonOptions::all_overrides() const {
  std::vector<std::string> all = overrides;
  if (seed) all.push_back("initial.seed=" + *seed);
  return all;
}

Scene CommonOptions::read() const { return read_scene(scene, all_overrides()); }

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("SCENE", options.scene, "scene file, or the name of a bundled scene")->required();
  command.add_option("--set", options.overrides, "table.key=value instead of what the scene says; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--seed", options.seed, "instead of initial.seed");
  command.add_option("--threads", options.threads, "threads to use at most; 0: as many as there are processors");
  command.add_flag("--quiet", options.quiet, "no messages but errors and the collapse report");
  command.add_flag("--progress", options.progress, "tell progress also where standard error is not a terminal");
}

}  // namespace cradle::tools
