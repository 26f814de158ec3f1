// An ensemble as in `cradle ensemble`, also under MPI, in which every fifth replica fails.
//   failing_ensemble SCENE REPLICAS FILE

#include <fmt/format.h>

#include <exception>
#include <string>

#include "cradle/tests/tools/ensemble/failing_replicas.hpp"
#include "cradle/tools/setup/read_scene.hpp"

int main(int, char** arguments) {
  using namespace cradle::tools;
  try {
    Interrupt interrupt;
    const auto processes = make_processes(interrupt);
    const EnsembleOptions options{.replicas = {0, std::stoull(arguments[2])}, .runner = cradle::tests::run_or_fail};
    const EnsembleOutcome end = run_study(ensemble_of(read_scene(arguments[1])), options, arguments[3], *processes);
    fmt::print("{}\n", end.outcome);
    return static_cast<int>(end.status);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
