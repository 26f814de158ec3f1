#include "cradle/tools/threshold/threshold.hpp"

#include <unistd.h>

#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

namespace {

struct ThresholdArguments : CommonOptions, OutputOptions {
  std::string vary, outcome;
  std::uint64_t digits = 12;
  bool no_proof = false;
};

Exit run_threshold(const ThresholdArguments& options) {
  const ThresholdProblem question(options.scene, options.all_overrides(), options.vary, options.outcome,
                                  static_cast<unsigned>(options.digits));
  const Scene& scene = question.at_low();
  if (!options.quiet) notify(scene.remarks);
  const std::string output = options.output_or(scene.name + "-threshold.h5");
  const FileClaim claim(output);
  Interrupt interrupt;
  note_signals(interrupt);
  const Threshold found = find_threshold(
      question, output, {interrupt, options.show(), options.threads, !options.no_proof, options.force()});
  const std::string command = question.command(options.scene) + (options.no_proof ? " --no-proof" : "");
  put_result(threshold_result(question, found, command), output, threshold_text(question, found), options.quiet);
  ::unlink((output + ".part").c_str());
  return Exit::done;
}

}  // namespace

void add_threshold(CommandLine& program) {
  Command command = program.add("threshold", "the value of a key at which the outcome of a run changes",
                                "cradle threshold collapse3 --vary law.restitution=0.05:0.1");
  auto& options = command.runs<ThresholdArguments>(run_threshold);
  add_common_options(command, options);
  command.option("--vary", options.vary, "KEY=LOW:HIGH, or KEY[I]=LOW:HIGH for number I of a list, from 0",
                 Needed::yes);
  command.option("--outcome", options.outcome,
                 "what is compared: collapse, gap, collisions, merges or pair (default: what suits the scene)");
  command.option("--digits", options.digits, {1, 900}, "digits of the value (default: 12)");
  command.flag("--no-proof", options.no_proof, "does not prove the outcomes of the last two runs");
  add_output_options(command, options, "result file (default: the scene's name with -threshold.h5)");
  command.note("An interrupted search is continued by the same command.");
}

}  // namespace cradle::tools
