// Who shares the replicas of ensembles: this process alone, or the ranks of an MPI job (mpi_crew.hpp). Rank 0 knows
// what is to be done, gives it out, and gets together what the others have.
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
  std::size_t point;  // of a sweep
  ReplicaRange replicas;
};
struct Job {
  std::size_t point;
  ReplicaIndex replica;
};
/// Where records go, one by one.
using PutRecord = std::function<void(std::string_view record)>;
/// The next job, in order; none: there are no more, or a signal says to stop. May be called from several threads.
using NextJob = std::function<std::optional<Job>()>;

/// That this process may use: launchers bind their processes to some of the machine's.
unsigned processors();

class Crew {
 public:
  /// Work ends before its time where the interrupt says so; it must outlive the crew.
  explicit Crew(Interrupt& interrupt) : interrupt_(interrupt) {}
  virtual ~Crew() = default;
  Interrupt& interrupt() const { return interrupt_; }
  virtual unsigned rank() const = 0;
  /// Of each rank, where nothing else is requested.
  virtual unsigned threads() const = 0;

  /// Runs a step on every rank. Where it throws on one of them, the first of these throws what it threw, and the others
  /// return its status: one message, one status for all.
  virtual Exit together(const std::function<void()>& step) = 0;

  /// Calls work(next) on every rank until rank 0's jobs are done; what another rank is given is not given again. Rank 0
  /// is called as others take up replicas. Returns the signal that ended it before, on any rank, or 0.
  virtual int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
                    const std::function<void(std::uint64_t replicas)>& others_took) = 0;

  /// Every other rank puts its records, rank 0 takes them.
  virtual void gather(const std::function<void(const PutRecord&)>& put, const PutRecord& take) = 0;

 private:
  Interrupt& interrupt_;
};

/// Jobs one after the other, in pieces as they are requested.
class JobQueue {
 public:
  explicit JobQueue(std::vector<JobRange> ranges) : ranges_(std::move(ranges)) {}

  /// At most `most` replicas of one point, starting and ending at a multiple of a power of two where that is possible,
  /// so that they make few nodes of the tree of replicas.
  std::optional<JobRange> take(std::uint64_t most);
  std::uint64_t left() const;
  void put(const JobRange& range) { ranges_.push_back(range); }

 private:
  std::vector<JobRange> ranges_;
  std::size_t at_ = 0;
};

class Alone : public Crew {
 public:
  using Crew::Crew;
  unsigned rank() const override { return 0; }
  unsigned threads() const override { return processors(); }
  Exit together(const std::function<void()>& step) override;
  int share(const std::vector<JobRange>& jobs, const std::function<void(const NextJob&)>& work,
            const std::function<void(std::uint64_t)>& others_took) override;
  void gather(const std::function<void(const PutRecord&)>&, const PutRecord&) override {}
};

/// The ranks of an MPI job where a launcher (mpirun, srun) started this process, else this process alone. Throws Error
/// where a launcher started several processes that do not see each other. One at a time, and once in a program.
std::unique_ptr<Crew> make_crew(Interrupt& interrupt);

}  // namespace cradle::tools
