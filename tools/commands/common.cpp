#include <fmt/format.h>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

std::vector<std::string> CommonOptions::all_overrides() const {
  std::vector<std::string> all = overrides;
  if (seed) all.push_back("initial.seed=" + *seed);
  return all;
}

Scene CommonOptions::read() const {
  Scene read = read_scene(scene, all_overrides());
  if (!quiet) notify(read.remarks);
  return read;
}

void put_result(const Result& result, const std::string& output, const std::string& text, bool quiet) {
  write_or_keep(result, output);
  fmt::print("{}", text);
  if (!quiet) fmt::print("wrote {}\n", output);
}

void add_output_options(Command& command, OutputOptions& options, const std::string& what, Needed needed) {
  command.option("-o,--output", options.output, what, needed);
  command.flag("--force", options.forced, "replace what is there, also what this command would not make again");
}

void add_common_options(Command& command, CommonOptions& options) {
  command.argument("SCENE", options.scene, "scene file, or the name of a bundled scene");
  command.repeated("--set", options.overrides,
                   "table.key=value instead of what the scene says, table.key= to remove a key; may be repeated",
                   "KEY=VALUE");
  command.option("--seed", options.seed, "instead of initial.seed");
  add_running_options(command, options);
}

void add_running_options(Command& command, RunningOptions& options) {
  command.option("--threads", options.threads,
                 "threads to use at most, for replicas or for one run of many particles; 0: all processors; never "
                 "changes a result");
  command.flag("--quiet", options.quiet, "no messages but errors, the collapse report and warnings about the result");
  command.flag("--progress", options.progress,
               "report progress every ten seconds where standard error is not a terminal, instead of every minute");
}

}  // namespace cradle::tools
