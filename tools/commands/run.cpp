#include "cradle/tools/run/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/result/atomic_file.hpp"
#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/tell.hpp"
#include "cradle/tools/support/threads.hpp"

namespace cradle::tools {

namespace {

struct RunArguments : CommonOptions {
  std::string output;
};

std::string summary(const RunOutcome& run, double seconds) {
  return fmt::format("{}: t = {}, {} contacts, energy {:.10g}, {:.2f} s, {:.1f} million contacts/s\n",
                     end_text(run.end), run.time, run.contacts, run.energy, seconds,
                     static_cast<double>(run.contacts) / seconds * 1e-6);
}

Exit run(const RunArguments& options) {
  const Scene scene = options.read();
  const std::string output = options.output.empty() ? scene.name + ".h5" : options.output;
  check_built(scene);
  const FileClaim claim(output);
  Interrupt interrupt;
  note_signals(interrupt);
  const auto started = std::chrono::steady_clock::now();
  const auto show = options.progress ? Progress::Show::always
                    : options.quiet  ? Progress::Show::never
                                     : Progress::Show::on_terminal;
  const Threads threads(options.threads);
  const RunOutcome end = run_scene(scene, {show, false, &interrupt, workers(threads)});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  // An existing file is replaced only by a run that went its way; one cut short leaves what it has beside it.
  const bool cut = end.end == RunEnd::interrupted;
  const std::string written = cut ? output + ".part" : output;
  write_or_keep(end.result, written);
  fmt::print("{}", end.report);
  tell(end.warning);
  if (cut) tell(fmt::format("interrupted: what was computed is in {}\n", written));
  if (!options.quiet) fmt::print("{}wrote {}\n", summary(end, seconds), written);
  return cut ? status_of_signal(interrupt.signal()) : status_of_end(end.end);
}

}  // namespace

void add_run(CommandLine& program) {
  Command command = program.add("run", "run a scene", "cradle run fig2 --set run.until=2000 -o fig2.h5");
  const auto options = std::make_shared<RunArguments>();
  add_common_options(command, *options);
  command.option("-o,--output", options->output, "result file (default: the scene's name with .h5, in this folder)");
  command.does([options] { return run(*options); });
}

}  // namespace cradle::tools
