#pragma once
// Shared by the benchmarks: the clock, the initial states of the published collision counts, and their check; and what
// the programs of Google Benchmark have in common. (Debian's prints "library was built as DEBUG": that concerns its own
// timers, not the measured code.)

#include <ctime>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/rows.hpp"

namespace bench {

using cradle::ParticleIndex;
using ParticlesPointer = std::shared_ptr<const cradle::Particles<double>>;

// By default processor time of the thread, which other work on the machine disturbs less.
inline double seconds_now(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work> double seconds_of(const Work& work, clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  const double start = seconds_now(clock);
  work();
  return seconds_now(clock) - start;
}

inline std::uint64_t hash(std::uint64_t i) { return cradle::splitmix64(i + 0x9E3779B97F4A7C15); }

// The paper's two rows, displaced by hashes.
template <class T> std::shared_ptr<const cradle::Rows<T>> rows(ParticleIndex n) {
  const auto displacement = [](ParticleIndex i) {
    return static_cast<std::int64_t>(hash(static_cast<std::uint64_t>(i)) & 0x3FFFF) - 131072;
  };
  return std::make_shared<cradle::Rows<T>>(cradle::symmetric_rows<T>(n, T(1) / T(2), T(1), displacement));
}

// Random velocities; masses are 1 and `other_mass` in turn; on a ring if it has a circumference.
template <class T = double>
std::shared_ptr<const cradle::Particles<T>> gas(ParticleIndex n, double other_mass = 1, const T& circumference = T(0),
                                                std::uint64_t seed = 0) {
  std::vector<T> x, v, m;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(n); ++i) {
    const std::uint64_t bits = hash(i + (seed << 32));
    x.push_back(T(static_cast<double>(i) + static_cast<double>(bits & 0xFFFFFFF) * 0x1p-29));
    v.push_back(T(static_cast<double>(bits >> 28) * 0x1p-35 - 1));
    if (other_mass != 1) m.push_back(T(i % 2 == 0 ? 1 : other_mass));
  }
  return std::make_shared<cradle::List<T>>(std::move(x), std::move(v), std::move(m), circumference);
}

// All engines must count the same collisions up to a time: the number expected or, if that is 0, that of the first one.
inline void check(const std::string& scene, const std::string& engine, double time, std::uint64_t found,
                  std::uint64_t expected) {
  static std::map<std::pair<std::string, double>, std::uint64_t> seen;
  if (expected == 0) expected = seen.try_emplace({scene, time}, found).first->second;
  if (found == expected) return;
  std::fprintf(stderr,
               "%s, %s: %llu collisions by t = %g (expected %llu): the engines do not agree, times mean nothing\n",
               scene.c_str(), engine.c_str(), static_cast<unsigned long long>(found), time,
               static_cast<unsigned long long>(expected));
  std::exit(1);
}

// ---- Google Benchmark

// Enters a measurement that states the time of its iterations.
template <class Measure> auto* enter_timed(const std::string& name, const Measure& measure) {
  return benchmark::RegisterBenchmark(name.c_str(), measure)->UseManualTime()->Unit(benchmark::kMillisecond);
}

// Collisions of all iterations.
inline void count(benchmark::State& state, std::uint64_t collisions) {
  using benchmark::Counter;
  state.counters["collisions"] = Counter(static_cast<double>(collisions), Counter::kAvgIterations);
  state.counters["collisions/s"] = Counter(static_cast<double>(collisions), Counter::kIsRate);
}

// The main function: makes those of the measurements entered that the command line chooses.
template <class EnterAll> int measure_all(int argc, char** argv, const EnterAll& enter_all) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  enter_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace bench
