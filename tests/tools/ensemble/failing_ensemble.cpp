// An ensemble as in `cradle ensemble`, also under MPI, in which every fifth replica fails: its particles are out of
// order, which throws.
//   failing_ensemble SCENE REPLICAS FILE

#include <fmt/format.h>

#include <exception>
#include <string>

#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/setup/read_scene.hpp"

int main(int, char** arguments) {
  using namespace cradle::tools;
  try {
    Interrupt interrupt;
    const auto processes = make_processes(interrupt);
    EnsembleOptions options;
    options.replicas = {0, std::stoull(arguments[2])};
    options.runner = [](const Scene& replica, const RunOptions& how) {
      Scene changed = replica;
      if (replica.initial.replica % 5 == 2) {
        changed.initial = {};
        changed.initial.type = InitialType::list;
        changed.initial.x = {"1", "0"};
        changed.initial.v = {"0", "0"};
      }
      return run_scene(changed, how);
    };
    const EnsembleOutcome end = run_study(ensemble_of(read_scene(arguments[1])), options, arguments[3], *processes);
    fmt::print("{}\n", end.outcome);
    return static_cast<int>(end.status);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
