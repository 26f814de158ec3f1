#include "cradle/tools/proof/trust.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

namespace {

struct TrustArguments : CommonOptions, OutputOptions {
  std::vector<unsigned> digits;
  bool both = false;

  std::string command() const {
    return fmt::format("trust{}{}", digits.empty() ? "" : fmt::format(" --digits {}", fmt::join(digits, ",")),
                       both ? " --both" : "");
  }
};

Exit run_trust(const TrustArguments& options) {
  const Scene scene = options.read();
  if (!std::ranges::is_sorted(options.digits, std::ranges::less_equal()))
    throw Error({"", 0, "--digits"}, "not rising", fmt::format("{}", fmt::join(options.digits, ",")),
                "give the reference, which has most of them, last");
  if (options.both && particles_merge(scene))
    throw Error({"", 0, "--both"}, "particles that merge are computed in gaps", "", "leave out --both");
  const std::string output = options.output_or(scene.name + "-trust.h5");
  const FileClaim claim = options.claim(output, options.command(), &scene);
  Interrupt interrupt;
  note_signals(interrupt);
  const auto runs = trust(scene, {options.digits, options.both, options.show(), &interrupt, options.threads});
  Result result = trust_result(scene, runs);
  result.attributes.emplace_back("command", options.command());
  put_result(result, output, trust_table(scene, runs), options.quiet);
  return Exit::done;
}

}  // namespace

void add_trust(CommandLine& program) {
  Command command = program.add("trust", "the same run at rising precision: which numbers are right, and until when",
                                "cradle trust fig2 --set run.until=1000 --digits 16,50");
  auto& options = command.runs<TrustArguments>(run_trust);
  add_common_options(command, options);
  command.list("--digits", options.digits, {10, 1000},
               "digits to compare, 10 to 1000, the reference last; 16 is double, 31 double-double, others mpfr "
               "(default: rising until two runs agree)");
  command.flag("--both", options.both, "in absolute coordinates too; a scene that has these is compared so anyway");
  add_output_options(command, options, "result file (default: the scene's name with -trust.h5)");
}

}  // namespace cradle::tools
