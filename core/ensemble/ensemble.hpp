#pragma once
// An ensemble: replicas of a run, each with its own initial data, and statistics of their numbers. Replicas are
// independent tasks, taken in order of their index. If one throws, it is recorded as failed, and the others continue.
// The statistics have the same bits on any number of threads, see ensemble/tree.hpp.
//
//   Ensemble energies;
//   run_replicas(TbbExecutor(), {0, 1000}, energies, [](ReplicaIndex k) { return energy_of_replica(k); });
//   energies.statistics().mean[0], energies.statistics().standard_error(0), energies.failures()

#include <atomic>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/ensemble/executor.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/ensemble/tree.hpp"

namespace cradle {

/// Thrown by an interrupted replica: it is neither done nor failed.
struct ReplicaAbandoned : std::exception {
  const char* what() const noexcept override { return "replica abandoned"; }
};

/// The message of the exception that is being handled.
inline std::string message_of_exception() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception without a message";
  }
}

/// Runs jobs: next() gives a job (a std::optional, empty at the end), replica(job) runs it, done(job, result) takes its
/// result, failed(job, message) the message of its exception. All are called from several threads at once. cancelled()
/// is called before every job; if it returns true, the ensemble ends when the running replicas have returned. An
/// exception from next, done or failed also ends it, and is thrown again here (the first if there are several).
template <Executor E, class Next, class Replica, class Done, class Failed>
void run_jobs(const E& executor, Next next, Replica replica, Done done, Failed failed,
              const std::function<bool()>& cancelled = {}) {
  std::atomic<bool> ended = false;
  std::exception_ptr first;
  std::mutex mutex;
  executor.run([&] {
    try {
      if (ended || (cancelled && cancelled())) return false;
      const auto job = next();
      if (!job) return false;
      std::optional<decltype(replica(*job))> result;
      try {
        result.emplace(replica(*job));
      } catch (const ReplicaAbandoned&) {
        return true;
      } catch (...) {
        failed(*job, message_of_exception());
        return true;
      }
      done(*job, std::move(*result));
      return true;
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!ended.exchange(true)) first = std::current_exception();
      return false;
    }
  });
  if (first) std::rethrow_exception(first);
}

/// Replica indices one by one, from ranges in order; may be called from several threads.
class ReplicaQueue {
 public:
  explicit ReplicaQueue(std::vector<ReplicaRange> ranges) : ranges_(std::move(ranges)) {}

  std::optional<ReplicaIndex> operator()() {
    const std::scoped_lock lock(mutex_);
    while (at_ < ranges_.size() && taken_ == ranges_[at_].count) ++at_, taken_ = 0;
    if (at_ == ranges_.size()) return std::nullopt;
    return ranges_[at_].first + taken_++;
  }

 private:
  std::vector<ReplicaRange> ranges_;
  std::size_t at_ = 0;
  std::uint64_t taken_ = 0;
  std::mutex mutex_;
};

/// A set of replicas: statistics of their vectors, and messages of the failed ones.
class Ensemble {
 public:
  void add(ReplicaIndex replica, std::vector<double> values) { tree_.add(replica, std::move(values)); }
  void fail(ReplicaIndex replica, std::string message) {
    {
      const std::scoped_lock lock(mutex_);
      failures_.emplace(replica, std::move(message));
    }
    tree_.add(replica, std::nullopt);
  }

  Moments statistics() const { return tree_.total(); }
  std::map<ReplicaIndex, std::string> failures() const {
    const std::scoped_lock lock(mutex_);
    return failures_;
  }
  const MomentTree& tree() const { return tree_; }

 private:
  MomentTree tree_;
  mutable std::mutex mutex_;
  std::map<ReplicaIndex, std::string> failures_;
};

/// Runs the replicas of the range that the ensemble does not have yet. replica(index) returns a std::vector<double>,
/// always of the same length, with NaN for missing numbers.
template <Executor E, class Replica>
void run_replicas(const E& executor, ReplicaRange range, Ensemble& ensemble, Replica replica,
                  const std::function<bool()>& cancelled = {}) {
  ReplicaQueue queue(ensemble.tree().missing(range));
  run_jobs(
      executor, [&] { return queue(); }, replica,
      [&](ReplicaIndex k, std::vector<double> values) { ensemble.add(k, std::move(values)); },
      [&](ReplicaIndex k, std::string message) { ensemble.fail(k, std::move(message)); }, cancelled);
}

}  // namespace cradle
