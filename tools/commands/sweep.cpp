#include "cradle/tools/ensemble/study.hpp"

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools {

namespace {

struct SweepArguments : CommonOptions, OutputOptions {
  Sweep sweep;
  std::uint64_t first = 0;
};

// The points of the command line or, without any, those of the scene.
StudyPlan plan(const SweepArguments& options) {
  const bool of_scene = options.sweep.vary.empty() && options.sweep.points.empty();
  const Scene scene =
      read_scene(options.scene, options.all_overrides(), of_scene ? SweepPoint() : sweep_points(options.sweep).front());
  Sweep sweep = scene.sweep;
  if (!of_scene) {
    sweep.vary = options.sweep.vary;
    sweep.points = options.sweep.points;
    sweep.cuts = options.sweep.cuts;
  }
  if (options.sweep.replicas > 0) sweep.replicas = options.sweep.replicas;
  return {sweep_of(options.scene, options.all_overrides(), sweep),
          {{options.first, sweep.replicas}, options.threads, options.show(), options.force()},
          options.output_or(scene.name + "-sweep.h5"),
          scene.remarks};
}

}  // namespace

void add_sweep(CommandLine& program) {
  Command command = program.add("sweep", "a scene at many points: one ensemble each, one file",
                                "cradle sweep fig4 --vary law.restitution=0.9:0.999:10 --replicas 10");
  auto& options = command.runs<SweepArguments>(
      [](const SweepArguments& given) { return run_study_command(given.quiet, [&] { return plan(given); }); });
  add_common_options(command, options);
  command.repeated("--vary", options.sweep.vary,
                   "or KEY=FROM:TO:COUNT:log, or KEY=VALUE,VALUE,...; of several, all combinations",
                   "KEY=FROM:TO:COUNT");
  command.flag("--cuts", options.sweep.cuts, "vary one key at a time, the others as in the scene");
  command.repeated("--point", options.sweep.points, "one point; may be repeated", "\"KEY=VALUE KEY=VALUE\"");
  command.option("--replicas", options.sweep.replicas, {1, most_replicas},
                 "replicas of every point (default: the scene's, or 1)");
  command.option("--first", options.first, {0, most_replicas}, "number of the first replica (default 0)");
  add_output_options(command, options,
                     "result file (default: the scene's name with -sweep.h5); one of this sweep that is there is "
                     "continued");
  command.note("Without --vary and --point the sweep is the one that the scene names in its table [sweep].");
}

}  // namespace cradle::tools
