// Finds out whether this process is one of several. MPI_Init without a launcher costs 0.3 s, so it is called only under
// one.
#include <cstdlib>
#include <initializer_list>
#include <string>

#include <fmt/format.h>

#include "cradle/tools/ensemble/crew.hpp"
#ifdef CRADLE_WITH_MPI
#include "cradle/tools/ensemble/mpi_crew.hpp"
#endif

namespace cradle::tools {

namespace {

// The variables of Open MPI; of MPICH, Intel MPI and Slurm by PMI; of Slurm by PMIx.
bool launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE", "PMI_FD", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

// The number of processes that the launcher states.
int processes() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* size = std::getenv(name)) return std::atoi(size);
  return 1;
}

}  // namespace

std::unique_ptr<Crew> make_crew(Interrupt& interrupt) {
  if (!launched()) return std::make_unique<Alone>(interrupt);
#ifdef CRADLE_WITH_MPI
  return make_mpi_crew(processes(), interrupt);
#else
  if (processes() > 1)
    throw Error("this program cannot share work between processes (" + std::to_string(processes()) +
                " were launched): build it where MPI is found, or run it without a launcher");
  return std::make_unique<Alone>(interrupt);
#endif
}

}  // namespace cradle::tools
