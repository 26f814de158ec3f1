#include "cradle/tools/run/trust.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

namespace {

struct Options : CommonOptions {
  std::vector<unsigned> digits;
  bool both = false;
  std::string output;
};

Exit run_trust(const Options& options) {
  const Scene scene = options.read();
  const std::string output = options.output.empty() ? scene.name + "-trust.h5" : options.output;
  check_writable(output);
  note_signals();
  const auto runs = trust(scene, {options.digits, options.both,
                                  options.progress ? Progress::Show::always
                                  : options.quiet  ? Progress::Show::never
                                                   : Progress::Show::on_terminal});
  write_result(trust_result(scene, runs), output);
  fmt::print("{}", trust_table(runs));
  if (!options.quiet) fmt::print("wrote {}\n", output);
  return Exit::done;
}

}  // namespace

void add_trust(CLI::App& program, Action& action) {
  auto* command = program.add_subcommand("trust", "the same run at rising precision: until when which number is right");
  const auto options = std::make_shared<Options>();
  add_common_options(*command, *options);
  command
      ->add_option("--digits", options->digits,
                   "digits to compare, the reference last; 16 is double, 31 double-double, others mpfr (default: "
                   "rising until two runs agree)")
      ->delimiter(',')
      ->check(CLI::Range(10U, 1000U))
      ->allow_extra_args(false);
  command->add_flag("--both", options->both, "in absolute coordinates too");
  command->add_option("-o,--output", options->output, "result file (default: the scene's name with -trust.h5)");
  command->callback([&action, options] { action = [options] { return run_trust(*options); }; });
}

}  // namespace cradle::tools
