// The work of one rank of a job. It runs on threads of its own, so that the main thread is free for messages; a queue
// of jobs is refilled as it runs out.
#pragma once

#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>

#include "cradle/tools/ensemble/processes.hpp"

namespace cradle::tools {

class WorkQueue {
 public:
  /// Begins work(next) at once. An interrupt ends the work early.
  WorkQueue(const std::function<void(const NextJob&)>& work, const Interrupt& interrupt)
      : interrupt_(interrupt), work_(std::async(std::launch::async, [this, work] {
          work([this](std::uint64_t most) { return next(most); });
        })) {}
  ~WorkQueue() { put({}); }  // and waits for the work
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Adds jobs; without any, the queue is closed: no more will be put.
  void put(const std::optional<JobRange>& piece) {
    const std::scoped_lock lock(mutex_);
    if (piece)
      jobs_.put(*piece);
    else
      closed_ = true;
    changed_.notify_all();
  }

  struct State {
    bool done, empty;     // the work has returned; all jobs are taken
    std::uint64_t taken;  // replicas that threads have taken
  };
  /// Waits a moment first or, if requested, until the last job is taken. Throws what the work threw.
  State state(bool or_empty) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(1), [&] { return or_empty && jobs_.left() == 0; });
    const bool done = work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (done) work_.get();
    return {done, jobs_.left() == 0, taken_};
  }

 private:
  std::optional<JobRange> next(std::uint64_t most) {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (interrupt_.signal() != 0) return std::nullopt;
      if (const auto piece = jobs_.take(most)) {
        taken_ += piece->replicas.count;
        changed_.notify_all();
        return piece;
      }
      if (closed_) return std::nullopt;
      changed_.wait_for(lock, std::chrono::milliseconds(10));  // wakes for signals, which notify nobody
    }
  }

  const Interrupt& interrupt_;
  std::mutex mutex_;
  std::condition_variable changed_;
  JobQueue jobs_{{}};
  bool closed_ = false;
  std::uint64_t taken_ = 0;
  std::shared_future<void> work_;  // last, since it uses all of the above
};

}  // namespace cradle::tools
