// Ensembles of a scene: replicas run on all threads (and ranks); one file holds the statistics of what they record.
// Finished replicas are never lost or run again: see ensemble_store.hpp. The same replicas give a file with the same
// bytes.
#pragma once

#include <cstdint>
#include <string>

#include "cradle/tools/ensemble/ensemble_store.hpp"
#include "cradle/tools/ensemble/processes.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

struct EnsembleOptions {
  ReplicaRange replicas;  // of every point: initial.replica of the runs
  unsigned threads = 0;   // of each rank; 0: one per processor
  ProgressLine::Show progress = ProgressLine::Show::on_terminal;
  Force force = Force::no;  // begin anew, and replace what is there
};

struct EnsembleOutcome {
  Exit status = Exit::done;      // if interrupted or terminated, finished replicas are in the journal
  std::uint64_t fresh = 0;       // replicas that were run now
  std::uint64_t replicas = 0;    // in the output now, those of earlier calls included
  std::string outcome;           // how they ended: "990 reached the end, 10 inelastic collapse"
  std::string account, warning;  // for standard error: of journals that were read, replicas that failed or lost order
};

/// Runs the wanted replicas of every point that `file` and its journals do not have yet, and writes the file. Throws
/// Error as EnsembleStore does. Under MPI all ranks call it with the same arguments; rank 0 gets the full outcome, the
/// others only a status.
EnsembleOutcome run_study(const Study& study, const EnsembleOptions& options, const std::string& file,
                          Processes& processes);

}  // namespace cradle::tools
