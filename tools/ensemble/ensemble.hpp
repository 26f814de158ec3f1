// Ensembles of a scene: replicas run on all threads (and ranks), statistics of what they record in one file. Finished
// replicas are never lost nor run again: see ensemble_store.hpp. The file has the same bytes for the same replicas.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cradle/tools/ranks/crew.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/ensemble_store.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

struct EnsembleOptions {
  ReplicaRange replicas;  // of every point: initial.replica of the runs
  unsigned threads = 0;   // of each rank; 0: as many as there are processors
  ProgressLine::Show progress = ProgressLine::Show::on_terminal;
  std::uint64_t journal_bytes = std::uint64_t{1} << 26;  // beyond which a journal is written anew, as statistics
  /// Runs the scene of one replica; what it throws is that replica's failure.
  std::function<RunOutcome(const Scene&, const RunOptions&)> runner = run_scene;
};

struct EnsembleOutcome {
  Exit status = Exit::done;    // interrupted and terminated: what was done is journalled
  std::uint64_t fresh = 0;     // replicas that were run now
  std::uint64_t replicas = 0;  // that are there now, those of earlier calls included
  std::string outcome;         // how they ended: "990 reached the end, 10 inelastic collapse"
  std::string account,
      warning;  // of journals that were read; of replicas that failed or lost order: for standard error
};

/// Runs what `file` and its journals do not have yet of the wanted replicas of every point, and writes the file. Throws
/// Error as EnsembleStore does. Under MPI all ranks call it with the same arguments; only rank 0 gets an outcome, the
/// others no more than a status.
EnsembleOutcome run_study(const Study& study, const EnsembleOptions& options, const std::string& file, Crew& crew);

/// The study of one scene, by this process alone.
EnsembleOutcome run_ensemble(const Scene& scene, const EnsembleOptions& options, const std::string& file);

}  // namespace cradle::tools
