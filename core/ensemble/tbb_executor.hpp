#pragma once
// The executor on oneTBB: every step is a task in an arena and a task group of its own, so that other uses of oneTBB in
// the program (cancellations, exceptions) do not interfere, nor the other way round.

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include "cradle/core/ensemble/executor.hpp"

namespace cradle {

class TbbExecutor {
 public:
  // More threads than processors only on request; oneTBB alone would not start them.
  explicit TbbExecutor(unsigned threads = 0)
      : threads_(thread_count(threads)), allowed_(oneapi::tbb::global_control::max_allowed_parallelism, threads_),
        arena_(static_cast<int>(threads_)) {}

  unsigned threads() const { return threads_; }

  void run(const Step& step) const {
    arena_.execute([&] {
      oneapi::tbb::task_group_context alone(oneapi::tbb::task_group_context::isolated);
      oneapi::tbb::task_group group(alone);
      for (unsigned k = 1; k < threads_; ++k) group.run(Link{group, step});
      group.run_and_wait(Link{group, step});
    });
  }

 private:
  // Runs one step, then starts the next one.
  struct Link {
    oneapi::tbb::task_group& group;
    const Step& step;
    void operator()() const {
      if (step()) group.run(*this);
    }
  };

  unsigned threads_;
  oneapi::tbb::global_control allowed_;
  mutable oneapi::tbb::task_arena arena_;
};

// The threads of a program. Under ThreadSanitizer plain ones, since it reports false races in Debian's oneTBB.
#ifdef __SANITIZE_THREAD__
using Threads = ThreadExecutor;
#else
using Threads = TbbExecutor;
#endif

}  // namespace cradle
