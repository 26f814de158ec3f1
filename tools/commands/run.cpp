#include "cradle/tools/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

struct RunArguments : CommonOptions, OutputOptions {};

std::string summary(const RunOutcome& run, std::uint64_t collisions_before) {
  const double per_second = static_cast<double>(run.collisions - collisions_before) / run.seconds;
  const int digits = std::clamp(static_cast<int>(run.energy_digits), 1, 10);
  return fmt::format("{}: t = {}, {} collisions, energy {:.{}g}{}, {:.2f} s{}, {}\n", end_row(run.end).text, run.time,
                     run.collisions, run.energy, digits,
                     run.energy_digits < 1 ? " (no digit is certain)"
                     : run.may_have_grown  ? " (unless errors have grown: cradle trust)"
                                           : "",
                     run.seconds, collisions_before > 0 ? " since it was continued" : "",
                     per_second < 1e5 ? fmt::format("{:.0f} collisions/s", per_second)
                                      : fmt::format("{:.1f} million collisions/s", per_second * 1e-6));
}

Exit run(const RunArguments& options) {
  const Scene scene = options.read();
  const std::string output = options.output_or(scene.name + ".h5");
  check_built(scene);
  Interrupt interrupt;
  note_signals(interrupt);
  const FileClaim claim = options.claim(output, "run", &scene);
  RunFiles files(output, scene, options.force());
  return run_command(files, output, options, interrupt, options.quiet ? "" : expected_warning(scene));
}

}  // namespace

Exit run_command(RunFiles& files, const std::string& output, const RunningOptions& options, Interrupt& interrupt,
                 const std::string& announcement) {
  const Threads threads(options.threads);
  const RunOutcome end =
      run_scene(files.scene(), {options.show(), nullptr, &interrupt, workers(threads), announcement}, files);
  const std::string text = summary(end, files.collisions_before());
  if (end.end == RunEnd::interrupted) {
    tools::notify(end.warning);
    tools::notify(
        files.up_to_date()
            ? fmt::format("interrupted: `cradle resume {}` continues from there\n", output)
            : fmt::format("interrupted: `cradle resume {}` continues from the previous checkpoint; without one, run "
                          "the scene again\n",
                          output));
    if (!options.quiet) fmt::print("{}", text);
    return status_of_signal(interrupt.signal());
  }
  fmt::print("{}", end.report);
  notify(end.warning);
  if (!options.quiet) fmt::print("{}wrote {}\n", text, output);
  return end_row(end.end).status;
}

void add_run(CommandLine& program) {
  Command command = program.add("run", "run a scene", "cradle run fig2 --set run.until=2000 -o fig2.h5");
  auto& options = command.runs<RunArguments>(run);
  add_common_options(command, options);
  add_output_options(command, options, "result file (default: the scene's name with .h5, in this folder)");
}

}  // namespace cradle::tools
