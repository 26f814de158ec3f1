// The processes that share the replicas of ensembles: this process alone, or the ranks of an MPI job
// (mpi_processes.cpp). Rank 0 knows the work, distributes it and collects the results.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

struct JobRange {
  std::size_t point;  // which point of a sweep
  ReplicaRange replicas;
};
/// Receives records, one by one.
using PutRecord = std::function<void(std::string_view record)>;
/// Gives the next replicas, at most so many, in order; nothing if there are no more or a signal says to stop. May be
/// called from several threads.
using NextJob = std::function<std::optional<JobRange>(std::uint64_t most)>;

/// The number of processors that this process may use: launchers bind their processes to some of the machine's.
unsigned processors();

class Processes {
 public:
  /// Work stops early if the interrupt says so; the interrupt must outlive the processes.
  explicit Processes(Interrupt& interrupt) : interrupt_(interrupt) {}
  virtual ~Processes() = default;
  Interrupt& interrupt() const { return interrupt_; }
  virtual unsigned rank() const = 0;
  /// The default number of threads of each rank.
  virtual unsigned threads() const = 0;

  /// Runs a step on every rank; true if it succeeded on all. If it throws on some ranks, the first of these rethrows
  /// and all others return false. These then have to end with status 0: launchers may discard what a rank still prints
  /// when another one fails.
  virtual bool together(const std::function<void()>& step) = 0;

  /// Calls work(next) on every rank until rank 0's jobs are done. Each job is given to one rank only. Rank 0 calls
  /// `others_took` when other ranks take replicas. Returns the signal that ended it early, on any rank, or 0.
  virtual int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
                    const std::function<void(std::uint64_t replicas)>& others_took) = 0;

  /// Every other rank puts its records; rank 0 takes them.
  virtual void gather(const std::function<void(const PutRecord&)>& put, const PutRecord& take) = 0;

 private:
  Interrupt& interrupt_;
};

/// Jobs in order, given out in pieces on request.
class JobQueue {
 public:
  explicit JobQueue(std::vector<JobRange> ranges) : ranges_(std::move(ranges)) {}

  /// At most `most` replicas of one point. Pieces start and end at multiples of a power of two if possible, so that
  /// they make few nodes in the tree of replicas.
  std::optional<JobRange> take(std::uint64_t most);
  std::uint64_t left() const;
  void put(const JobRange& range) { ranges_.push_back(range); }

 private:
  std::vector<JobRange> ranges_;
  std::size_t at_ = 0;
};

class OneProcess : public Processes {
 public:
  using Processes::Processes;
  unsigned rank() const override { return 0; }
  unsigned threads() const override { return processors(); }
  bool together(const std::function<void()>& step) override { return step(), true; }
  int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
            const std::function<void(std::uint64_t)>& others_took) override;
  void gather(const std::function<void(const PutRecord&)>&, const PutRecord&) override {}
};

/// The ranks of an MPI job if a launcher (mpirun, srun) started this process, else this process alone: MPI_Init without
/// a launcher costs 0.3 s. Throws Error if a launcher started several processes that do not see each other. Call it
/// once in a program.
std::unique_ptr<Processes> make_processes(Interrupt& interrupt);
#ifdef CRADLE_WITH_MPI
std::unique_ptr<Processes> make_mpi_processes(int processes_launched, Interrupt& interrupt);
#endif

}  // namespace cradle::tools
