// Ensembles across machines: the ranks of an MPI job. Rank 0 gives aligned pieces of the remaining replicas to ranks
// that request them, large pieces first and smaller ones towards the end; the threads of a rank share its pieces. Only
// the main thread calls MPI, and it does nothing else; other threads do the work. If a rank dies the launcher ends the
// job; the next job finds the journals of all ranks.
#pragma once

#include <memory>

#include "cradle/tools/ensemble/crew.hpp"

namespace cradle::tools {

/// Starts MPI; call it only under a launcher. Throws Error if the ranks do not see each other.
std::unique_ptr<Crew> make_mpi_crew(int processes_launched, Interrupt& interrupt);

}  // namespace cradle::tools
