#include "cradle/tools/run/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

namespace {

struct Options : CommonOptions {
  std::string output;
};

std::string summary(const Result& result, double seconds) {
  const auto& series = result.find("series")->columns;
  const auto last = [&](std::size_t column) {
    return std::visit([](const auto& values) { return static_cast<double>(values.back()); }, series[column].values);
  };
  const double contacts = last(3);
  return fmt::format("{}: t = {}, {:.0f} contacts, energy {:.10g}, {:.2f} s, {:.1f} million contacts/s\n",
                     attribute<std::string>(result.attributes, "outcome", ""), last(0), contacts, last(1), seconds,
                     contacts / seconds * 1e-6);
}

Exit run(const Options& options) {
  const Scene scene = options.read();
  const std::string output = options.output.empty() ? scene.name + ".h5" : options.output;
  check_built(scene);
  check_writable(output);
  note_signals();
  const auto started = std::chrono::steady_clock::now();
  const RunOutcome end = run_scene(scene, {options.progress ? Progress::Show::always
                                           : options.quiet  ? Progress::Show::never
                                                            : Progress::Show::on_terminal});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  // An existing file is replaced only by a run that went its way; one cut short leaves what it has beside it.
  const bool cut = end.status == Exit::interrupted || end.status == Exit::terminated;
  const std::string written = cut ? output + ".part" : output;
  write_result(end.result, written);
  fmt::print("{}", end.report);
  if (!end.warning.empty()) fmt::print(stderr, "{}", end.warning);
  if (cut) fmt::print(stderr, "interrupted: what was computed is in {}\n", written);
  if (!options.quiet) fmt::print("{}wrote {}\n", summary(end.result, seconds), written);
  return end.status;
}

}  // namespace

void add_run(CommandLine& program) {
  Command command = program.add("run", "run a scene", "cradle run fig2 --set run.until=2000 -o fig2.h5");
  const auto options = std::make_shared<Options>();
  add_common_options(command, *options);
  command.option("-o,--output", options->output, "result file (default: the scene's name with .h5, in this folder)");
  command.does([options] { return run(*options); });
}

}  // namespace cradle::tools
