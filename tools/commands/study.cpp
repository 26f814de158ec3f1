#include "cradle/tools/commands/study.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/theory/cost.hpp"

namespace cradle::tools {

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

}  // namespace cradle::tools
