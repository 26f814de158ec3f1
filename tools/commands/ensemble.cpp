#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/study.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

struct EnsembleArguments : CommonOptions, OutputOptions {
  std::uint64_t replicas = 0, first = 0;
  std::vector<std::string> spreads;
};

// NAME=FROM:TO:BINS
SpreadRequest spread(const std::string& text) {
  const auto wrong = [&] {
    return Error({"--spread", 0, ""}, "not a quantity and bins", text,
                 "give NAME=FROM:TO:BINS, as in energy=0:1000:50");
  };
  const auto equals = text.find('='), colon = text.find(':', equals), second = text.find(':', colon + 1);
  if (equals == text.npos || colon == text.npos || second == text.npos) throw wrong();
  const auto number = [&](std::size_t from, std::size_t to) {
    if (const auto value = to_number(text.substr(from, to - from))) return *value;
    throw wrong();
  };
  const double from = number(equals + 1, colon), to = number(colon + 1, second), bins = number(second + 1, text.size());
  if (!(from < to) || !(bins >= 1 && bins <= 1e6) || bins != std::floor(bins)) throw wrong();
  return {text.substr(0, equals), {from, to, static_cast<std::size_t>(bins)}};
}

StudyPlan plan(const EnsembleArguments& options) {
  const Scene scene = read_scene(options.scene, options.all_overrides());
  std::vector<SpreadRequest> spreads;
  for (const std::string& text : options.spreads) spreads.push_back(spread(text));
  return {ensemble_of(scene, std::move(spreads)),
          {{options.first, options.replicas}, options.threads, options.show(), options.force()},
          options.output_or(scene.name + "-ensemble.h5"),
          scene.remarks};
}

}  // namespace

Exit run_study_command(bool quiet, const std::function<StudyPlan()>& make_plan) {
  Interrupt interrupt;
  note_signals(interrupt);
  const std::unique_ptr<Processes> processes = make_processes(interrupt);
  StudyPlan plan;
  if (!processes->together([&] { plan = make_plan(); })) return Exit::done;
  if (processes->rank() == 0) notify(same_replicas_warning(plan.study, plan.options.replicas.count));
  if (processes->rank() == 0 && !quiet) notify(plan.note);
  if (processes->rank() == 0 && !quiet)
    for (const auto& [group, scene] : plan.study.points)
      if (const Cost cost = expected_cost(scene); !cost.endless.empty() || cost.floor) {
        notify(expected_warning(scene));
        break;
      }
  const std::string& output = plan.output;
  const auto started = std::chrono::steady_clock::now();
  const EnsembleOutcome end = run_study(plan.study, plan.options, output, *processes);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  if (processes->rank() != 0) return end.status;
  if (!quiet) notify(end.account);
  notify(end.warning);
  if (end.status == Exit::interrupted || end.status == Exit::terminated) {
    notify(fmt::format(
        "interrupted: finished replicas are in {}.part; the same command continues from there, or `cradle resume {}`\n",
        output, output));
  } else if (!quiet) {
    fmt::print("{} replicas: {}\n", end.replicas, end.outcome);
    if (end.fresh > 0)
      fmt::print("{} of them now, {:.2f} s, {:.4g} replicas/s\nwrote {}\n", end.fresh, seconds,
                 static_cast<double>(end.fresh) / seconds, output);
    else
      fmt::print("nothing to do: {} has them all\n", output);
  }
  return end.status;
}

void add_ensemble(CommandLine& program) {
  Command command = program.add("ensemble", "replicas of a scene with different perturbations, and statistics",
                                "cradle ensemble fig4 --replicas 100");
  auto& options = command.runs<EnsembleArguments>(
      [](const EnsembleArguments& given) { return run_study_command(given.quiet, [&] { return plan(given); }); });
  add_common_options(command, options);
  command.option("--replicas", options.replicas, {1, most_replicas},
                 "how many; those that FILE has already are not run again", Needed::yes);
  command.option("--first", options.first, {0, most_replicas},
                 "number of the first one (default 0): initial.replica of its run");
  command.repeated("--spread", options.spreads,
                   "count the values of a quantity in bins, and give quantiles; NAME as in series/; may be repeated",
                   "NAME=FROM:TO:BINS");
  add_output_options(command, options,
                     "result file (default: the scene's name with -ensemble.h5); an ensemble of this scene that is "
                     "there is continued");
  command.note(
      "Snapshots, masses and events of the scene are left out. Finished replicas are kept in FILE.part: the same "
      "command continues from there.");
}

}  // namespace cradle::tools
