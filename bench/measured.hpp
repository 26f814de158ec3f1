#pragma once
// Shared by the programs of Google Benchmark. Debian's prints "library was built as DEBUG": that concerns its own
// timers, not the measured code.

#include <string>

#include <benchmark/benchmark.h>

#include "common.hpp"

namespace bench {

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
