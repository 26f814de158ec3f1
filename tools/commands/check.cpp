#include <fmt/format.h>

#include "cradle/core/ensemble/executor.hpp"
#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

Exit check(const CommonOptions& options) {
  const Scene scene = options.read();
  for (const auto& [key, value] : values(scene, true)) fmt::print("{} = {}\n", key, shortened(value));
  check_built(scene);
  if (scene.initial.type == InitialType::clusters) {
    fmt::print("\na model of two clusters: no particles, no collisions; below a second\n");
    return Exit::done;
  }
  check_particles(scene);

  const Cost cost = expected_cost(scene);
  if (cost.memory < 1e8) begin_engine(scene, {});  // refuses what a run does
  fmt::print("\nparticles in the active zone at the end: {} at most\n", about(cost.particles, 3));
  fmt::print("{}", expected_lines(scene, cost));
  if (cost.collisions) {
    const bool of_a_part = cost.collapse || cost.clustering;
    const double seconds = *cost.collisions / cost.collisions_per_second + (of_a_part ? 0 : cost.seconds_of_samples);
    fmt::print("time{}: about {} s{} at {} collisions/s\n", of_a_part ? " until then" : "", about(seconds),
               of_a_part ? "" : ", with samples,", about(cost.collisions_per_second));
  }
  const unsigned threads = thread_count(options.threads);
  const Threading threading = expected_threading(scene, cost, threads);
  if (threading.alone.empty())
    fmt::print("threads: {}, about {:.2g} times as fast as one once all particles are active\n", threads,
               threading.gain);
  else
    fmt::print("threads: one does the work ({})\n", threading.alone);
  fmt::print("memory: about {} MB\n", about(cost.memory * 1e-6));
  return Exit::done;
}

}  // namespace

void add_check(CommandLine& program) {
  Command command =
      program.add("check", "validate a scene without running it: effective values, expected cost", "cradle check fig2");
  auto& options = command.runs<CommonOptions>(check);
  add_common_options(command, options);
}

}  // namespace cradle::tools
