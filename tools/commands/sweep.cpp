#include "cradle/tools/ensemble/sweep.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/commands/study.hpp"

namespace cradle::tools {

namespace {

struct Options : CommonOptions {
  Sweep sweep;
  std::uint64_t first = 0;
  std::string output;
};

// What the command line says, else what the scene says.
StudyPlan plan(const Options& options) {
  const Scene scene = options.read();
  Sweep sweep = scene.sweep;
  if (!options.sweep.vary.empty() || !options.sweep.points.empty()) {
    sweep.vary = options.sweep.vary;
    sweep.points = options.sweep.points;
    sweep.cuts = options.sweep.cuts;
  }
  if (options.sweep.replicas > 0) sweep.replicas = options.sweep.replicas;
  return {sweep_of(options.scene, options.all_overrides(), sweep),
          {options.first, sweep.replicas},
          options.output.empty() ? scene.name + "-sweep.h5" : options.output};
}

}  // namespace

void add_sweep(CLI::App& program, Action& action) {
  auto* command = program.add_subcommand("sweep", "a scene at many points: one ensemble each, one file");
  const auto options = std::make_shared<Options>();
  add_common_options(*command, *options);
  command
      ->add_option("--vary", options->sweep.vary,
                   "KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or KEY=VALUE,VALUE,...; of several, all combinations")
      ->allow_extra_args(false);
  command->add_flag("--cuts", options->sweep.cuts, "vary one key at a time, the others as in the scene");
  command->add_option("--point", options->sweep.points, "\"KEY=VALUE KEY=VALUE\": one point; may be repeated")
      ->allow_extra_args(false);
  constexpr std::uint64_t most = std::uint64_t{1} << 53;
  command->add_option("--replicas", options->sweep.replicas, "replicas of every point (default: the scene's, or 1)")
      ->check(CLI::Range(std::uint64_t{1}, most));
  command->add_option("--first", options->first, "number of the first replica (default 0)")
      ->check(CLI::Range(std::uint64_t{0}, most));
  command->add_option("-o,--output", options->output,
                      "result file (default: the scene's name with -sweep.h5); one of this sweep that is there is "
                      "continued");
  command->footer("Without --vary and --point the sweep is the one that the scene names in its table [sweep].");
  command->callback([&action, options] {
    action = [options] { return run_study_command(*options, [&] { return plan(*options); }); };
  });
}

}  // namespace cradle::tools
