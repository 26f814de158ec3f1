// Ensembles across machines: the ranks of an MPI job. Rank 0 gives out aligned pieces of the replicas that are left,
// large ones first and smaller ones towards the end, to whoever requests them; threads within a rank take theirs from
// its pieces. MPI is called from the main thread only, which does nothing else; the work is done on others. When a rank
// dies the launcher ends the job: what every rank journalled is there for the next one.
#pragma once

#include <memory>

#include "cradle/tools/ranks/crew.hpp"

namespace cradle::tools {

/// Starts MPI; to be called under a launcher only. Throws Error where the ranks do not see each other.
std::unique_ptr<Crew> make_mpi_crew(int processes_launched, Interrupt& interrupt);

}  // namespace cradle::tools
