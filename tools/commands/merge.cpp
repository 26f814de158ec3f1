#include <fmt/format.h>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/result/files.hpp"

namespace cradle::tools {

namespace {

struct MergeArguments : OutputOptions {
  bool quiet = false;
  std::vector<std::string> files;
};

Exit merge(const MergeArguments& options) {
  const FileClaim claim(options.output);
  const auto all = merged(options.files);
  if (!options.forced) all->check_replaces(options.output);
  const Result result = all->result();
  write_result(result, options.output);
  if (options.quiet) return Exit::done;
  fmt::print("{} replicas: {}\nwrote {}\n", attribute<std::uint64_t>(result.attributes, "replicas", options.output),
             attribute<std::string>(result.attributes, "outcome", options.output), options.output);
  return Exit::done;
}

}  // namespace

void add_merge(CommandLine& program) {
  Command command = program.add("merge", "ensembles (or sweeps) of the same scene with different replicas, as one",
                                "cradle merge first.h5 second.h5 -o all.h5");
  auto& options = command.runs<MergeArguments>(merge);
  command.arguments("FILE", options.files, "result files of `cradle ensemble` or `cradle sweep`");
  add_output_options(command, options, "result file", Needed::yes);
  command.flag("--quiet", options.quiet, "no message about the file");
}

}  // namespace cradle::tools
