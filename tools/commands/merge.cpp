#include <fmt/format.h>

#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/store.hpp"
#include "cradle/tools/ensemble/sweep.hpp"

namespace cradle::tools {

namespace {

struct Options {
  std::vector<std::string> files;
  std::string output;
};

Study study_in(const std::string& file) {
  const Result result = read_result(file);
  return study_kind(result, file) == "sweep" ? sweep_in(result, file) : ensemble_in(result, file);
}

Exit merge(const Options& options) {
  const Study study = study_in(options.files.front());
  EnsembleStore all(study, options.output);
  for (const std::string& file : options.files) {
    EnsembleStore one(study, file);
    one.load_result();
    all.merge(one);
  }
  check_writable(options.output);
  const Result result = all.result();
  write_result(result, options.output);
  fmt::print("{} replicas: {}\nwrote {}\n", attribute<std::uint64_t>(result.attributes, "replicas", options.output),
             attribute<std::string>(result.attributes, "outcome", options.output), options.output);
  return Exit::done;
}

}  // namespace

void add_merge(CommandLine& program) {
  Command command = program.add("merge", "ensembles (or sweeps) of the same scene with different replicas, as one",
                                "cradle merge first.h5 second.h5 -o all.h5");
  const auto options = std::make_shared<Options>();
  command.arguments("FILE", options->files, "result files of `cradle ensemble` or `cradle sweep`");
  command.option("-o,--output", options->output, "result file", Needed::yes);
  command.does([options] { return merge(*options); });
}

}  // namespace cradle::tools
