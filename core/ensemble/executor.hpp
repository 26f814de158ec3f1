#pragma once
// An executor runs work on threads: it calls a step again and again, on several threads at once, until it reports that
// nothing is left. Programs use the one on oneTBB (tbb_executor.hpp). This one uses plain threads. It exists for
// ThreadSanitizer, which reports false races inside Debian's oneTBB.

#include <algorithm>
#include <concepts>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "cradle/core/parallel/workers.hpp"

namespace cradle {

/// A step returns false when nothing is left to do, and throws nothing. All threads may call it at once. `run` returns
/// when the last call has returned.
using Step = std::function<bool()>;

template <class E>
concept Executor = requires(const E executor, const Step& step) {
  executor.run(step);
  { executor.threads() } -> std::same_as<unsigned>;
};

/// 0 threads: as many as this process has processors.
inline unsigned thread_count(unsigned threads) {
  return threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

class ThreadExecutor {
 public:
  explicit ThreadExecutor(unsigned threads = 0) : threads_(thread_count(threads)) {}

  unsigned threads() const { return threads_; }

  void run(const Step& step) const {
    const auto work = [&step] {
      while (step()) {
      }
    };
    std::vector<std::jthread> others;
    for (unsigned k = 1; k < threads_; ++k) others.emplace_back(work);
    work();
  }

 private:
  unsigned threads_;
};

/// Calls work(job, worker) for all jobs from 0 to jobs - 1 on the executor's threads, and returns when they are done.
/// `worker` is below the number of threads, and differs between calls that run at the same time. The first exception
/// from `work` is thrown again here when no call is running; jobs not begun by then are dropped.
/// Worker k begins with the k-th part of the jobs and then takes what others have left. A thread stays the same worker
/// where it can: from one call to the next a job's data are still in the caches of its processor.
template <Executor E> void for_each(const E& executor, std::size_t jobs, const Workers::Work& work) {
  if (jobs == 1) return work(0, 0);
  struct Part {
    std::size_t next, end;  // jobs
    bool idle = true;
    std::size_t left() const { return end - next; }
  };
  const std::size_t threads = executor.threads();
  std::vector<Part> parts;
  for (std::size_t k = 0; k < threads; ++k) parts.push_back({jobs * k / threads, jobs * (k + 1) / threads});
  std::mutex mutex;
  std::exception_ptr thrown;
  executor.run([&] {
    thread_local std::size_t home = 0;  // the worker that this thread was last
    std::size_t job = 0;
    {
      const std::lock_guard lock(mutex);
      const auto most = std::ranges::max_element(parts, {}, &Part::left);
      if (most->left() == 0) return false;
      if (home >= threads || !parts[home].idle)
        home = static_cast<std::size_t>(std::ranges::find(parts, true, &Part::idle) - parts.begin());
      job = parts[home].left() > 0 ? parts[home].next++ : --most->end;
      parts[home].idle = false;
    }
    std::exception_ptr now;
    try {
      work(job, home);
    } catch (...) {
      now = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    if (now && !thrown) {
      thrown = now;
      for (Part& part : parts) part.next = part.end;
    }
    parts[home].idle = true;
    return true;
  });
  if (thrown) std::rethrow_exception(thrown);
}

/// The executor's threads for the segments of one run. Refers to the executor.
template <Executor E> Workers workers(const E& executor) {
  if (executor.threads() < 2) return {};
  return {executor.threads(),
          [&executor](std::size_t jobs, const Workers::Work& work) { for_each(executor, jobs, work); }};
}

}  // namespace cradle
