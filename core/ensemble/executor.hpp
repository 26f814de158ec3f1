#pragma once
// Who does the work: an executor calls a step again and again, on several threads at once, until it is told that there
// is none left. The one on oneTBB (tbb_executor.hpp) is what programs use. This one, on plain threads, does the same,
// and is there for ThreadSanitizer, which sees races inside Debian's oneTBB that are none.

#include <algorithm>
#include <concepts>
#include <functional>
#include <thread>
#include <vector>

namespace cradle {

/// A step returns false when there is nothing left to do, and throws nothing. It may be called from all threads at
/// once. `run` returns when the last of them is through.
using Step = std::function<bool()>;

template <class E>
concept Executor = requires(const E executor, const Step& step) {
  executor.run(step);
  { executor.threads() } -> std::same_as<unsigned>;
};

/// 0 threads: as many as there are processors for this process.
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

}  // namespace cradle
