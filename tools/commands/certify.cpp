#include "cradle/tools/proof/certify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cradle/tools/commands/commands.hpp"

namespace cradle::tools {

namespace {

struct CertifyArguments : CommonOptions, OutputOptions {
  std::vector<unsigned> digits;
  std::uint64_t replicas = 0;

  std::string command() const {
    return fmt::format("certify{}{}", digits.empty() ? "" : fmt::format(" --digits {}", fmt::join(digits, ",")),
                       replicas == 0 ? "" : fmt::format(" --replicas {}", replicas));
  }
};

Exit run_certify(const CertifyArguments& options) {
  const Scene scene = options.read();
  check_certifiable(scene);
  const std::string output = options.output_or(scene.name + "-certified.h5");
  const FileClaim claim = options.claim(output, options.command(), &scene);
  Interrupt interrupt;
  note_signals(interrupt);
  const CertifyOptions how{.digits = options.digits.empty() ? rising_digits() : options.digits,
                           .progress = options.show(),
                           .interrupt = &interrupt,
                           .threads = options.threads};
  if (options.replicas > 0) {
    const CertifiedReplicas run = certify_replicas(scene, options.replicas, options.threads, how);
    Result result = replicas_result(run);
    say_how_made(result, options.command(), scene);
    put_result(result, output, replicas_text(run), options.quiet);
    const bool all = std::all_of(run.replicas.begin(), run.replicas.end(), [](const auto& r) { return r.proved; });
    return all ? Exit::done : Exit::lost;
  }
  Certified run = certify(scene, how);
  const std::string &report = run.outcome.report,
                    text = certificate_text(run) + (options.quiet ? "" : attempts_text(run)) +
                           (report.empty() ? "" : "by the run, not checked by the proof:\n" + report),
                    warning = run.outcome.warning;
  const bool proved = run.proved();
  Result result = certified_result(std::move(run));
  say_how_made(result, options.command(), scene);
  put_result(result, output, text, options.quiet);
  notify(warning);
  return proved ? Exit::done : Exit::lost;
}

}  // namespace

void add_certify(CommandLine& program) {
  Command command = program.add("certify", "the run with a proof of its collisions, and bounds of its results",
                                "cradle certify fig2 --set run.until=2000 -o fig2.h5");
  auto& options = command.runs<CertifyArguments>(run_certify);
  add_common_options(command, options);
  command.list("--digits", options.digits, {31, 1000},
               "digits of the proof, tried one after the other, 31 to 1000; 31 is double-double, others mpfr (default: "
               "31,50,100,200,400,800)");
  command.option("--replicas", options.replicas, {1, 1'000'000},
                 "prove so many replicas with different perturbations, and give statistics of those that are");
  add_output_options(command, options, "result file (default: the scene's name with -certified.h5)");
  command.note("exit status: 0 proved, 5 undecided");
}

}  // namespace cradle::tools
