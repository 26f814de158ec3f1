#include "cradle/tools/ensemble/processes.hpp"

#include <sched.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <mutex>
#include <string>

namespace cradle::tools {

namespace {

// Whether a launcher started this process: Open MPI sets the first variable; MPICH, Intel MPI and Slurm set those of
// PMI; Slurm also the one of PMIx.
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

unsigned processors() {
#ifdef __linux__
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
#endif
  return thread_count(0);  // for systems that do not bind processes, and machines with more than 1024 processors
}

std::optional<JobRange> JobQueue::take(std::uint64_t most) {
  while (at_ < ranges_.size() && ranges_[at_].replicas.count == 0) ++at_;
  if (at_ == ranges_.size() || most == 0) return std::nullopt;
  auto& [point, replicas] = ranges_[at_];
  std::uint64_t count = std::bit_floor(std::min(most, replicas.count));
  if (replicas.first != 0) count = std::min(count, std::uint64_t{1} << std::countr_zero(replicas.first));
  const JobRange piece{point, {replicas.first, count}};
  replicas.first += count;
  replicas.count -= count;
  return piece;
}

std::uint64_t JobQueue::left() const {
  std::uint64_t sum = 0;
  for (std::size_t k = at_; k < ranges_.size(); ++k) sum += ranges_[k].replicas.count;
  return sum;
}

int OneProcess::share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
                      const std::function<void(std::uint64_t)>&) {
  JobQueue queue(jobs);
  std::mutex mutex;
  work([&](std::uint64_t most) -> std::optional<JobRange> {
    if (interrupt().signal() != 0) return std::nullopt;
    const std::scoped_lock lock(mutex);
    return queue.take(most);
  });
  return interrupt().signal();
}

std::unique_ptr<Processes> make_processes(Interrupt& interrupt) {
  if (!launched()) return std::make_unique<OneProcess>(interrupt);
#ifdef CRADLE_WITH_MPI
  return make_mpi_processes(processes(), interrupt);
#else
  if (processes() > 1)
    throw Error({}, "a program without MPI cannot share work between processes",
                std::to_string(processes()) + " launched", "build it where MPI is found, or run it without a launcher");
  return std::make_unique<OneProcess>(interrupt);
#endif
}

}  // namespace cradle::tools
