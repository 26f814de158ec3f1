#pragma once
// The threads that compute the segments of a run (segments.hpp): this one, or several by ensemble/executor.hpp.

#include <cstddef>
#include <functional>

namespace cradle {

constexpr std::size_t gaps_per_thread = 500;  // with fewer a thread gains nothing

// Calls work(job, worker) for all jobs from 0 to jobs - 1, and returns when they are done. Several calls may run at
// once, with different numbers `worker` below `count`. (ensemble/executor.hpp makes one of threads.)
struct Workers {
  using Work = std::function<void(std::size_t job, std::size_t worker)>;
  std::size_t count = 1;
  std::function<void(std::size_t jobs, const Work& work)> run = [](std::size_t jobs, const Work& work) {
    for (std::size_t job = 0; job < jobs; ++job) work(job, 0);
  };
};

}  // namespace cradle
