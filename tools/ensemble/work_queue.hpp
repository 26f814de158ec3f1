// The work of one rank of a job. It runs on threads of its own, so that the main thread is free for messages; a queue
// of jobs is refilled as it runs out.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <mutex>
#include <optional>

#include "cradle/tools/ensemble/processes.hpp"

namespace cradle::tools {

class WorkQueue {
 public:
  /// Begins work(next) at once. `put` adds jobs until it is closed. An interrupt ends the work early.
  WorkQueue(const std::function<void(const NextJob&)>& work, const Interrupt& interrupt)
      : interrupt_(interrupt), work_(std::async(std::launch::async, [this, work] {
          work([this](std::uint64_t most) { return next(most); });
        })) {}
  ~WorkQueue() { close(); }  // and waits for the work
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  void put(const JobRange& piece) {
    const std::scoped_lock lock(mutex_);
    jobs_.put(piece);
    changed_.notify_all();
  }
  /// No more jobs will be put.
  void close() {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  bool empty() const {
    const std::scoped_lock lock(mutex_);
    return jobs_.left() == 0;
  }
  /// The number of replicas that threads have taken.
  std::uint64_t taken() const {
    const std::scoped_lock lock(mutex_);
    return taken_;
  }

  /// True when the work has returned; throws what the work threw. Waits a moment first or, if requested, until the last
  /// job is taken.
  bool idle(bool or_empty) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(1), [&] { return or_empty && jobs_.left() == 0; });
    if (work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    work_.get();
    return true;
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
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  JobQueue jobs_{{}};
  bool closed_ = false;
  std::uint64_t taken_ = 0;
  std::shared_future<void> work_;  // last, since it uses all of the above
};

}  // namespace cradle::tools
