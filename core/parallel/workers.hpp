#pragma once
// Who computes the segments of a run (segments.hpp): this thread, or, by ensemble/executor.hpp, several.

#include <cstddef>
#include <functional>

namespace cradle {

constexpr std::size_t gaps_per_thread = 500;  // at least, for a thread to pay

// Calls work(job, worker) for all jobs from 0 to jobs - 1, and returns when they are done.
// Several may run at once, each with another worker below `count`. (ensemble/executor.hpp makes one of threads.)
struct Workers {
  using Work = std::function<void(std::size_t job, std::size_t worker)>;
  std::size_t count = 1;
  std::function<void(std::size_t jobs, const Work& work)> run = [](std::size_t jobs, const Work& work) {
    for (std::size_t job = 0; job < jobs; ++job) work(job, 0);
  };
};

}  // namespace cradle
