// Collisions per second of Cradle in the gas of gas.h, for comparison with other programs (compare.py).
//
//   peer_cradle PARTICLES UNTIL     prints a line per engine: name, collisions, seconds
//
// Seconds are processor time of the thread; with two threads, time by the clock.
#include <cstdio>
#include <cstdlib>

#include "../common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "gas.h"

namespace {

using Law = cradle::Inelastic<double>;
using Chain = cradle::GapChain<double, cradle::IndividualMasses<double>>;
using Run = cradle::Simulation<double, Law, Chain>;

template <class Advance> void measure(const char* engine, std::uint64_t particles, clockid_t clock, Advance advance) {
  Run run(
      Law(1, 0),
      Chain(bench::gas(static_cast<cradle::ParticleIndex>(particles), heavier, static_cast<double>(particles)), 0.));
  const double start = bench::seconds_now(clock);
  advance(run);
  std::printf("%s %llu %.4f\n", engine, static_cast<unsigned long long>(run.counts().collisions),
              bench::seconds_now(clock) - start);
}

void measure_segments(const char* engine, std::uint64_t particles, double until, unsigned threads) {
  measure(engine, particles, threads > 1 ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, [&](Run& run) {
    cradle::TbbExecutor executor(threads);
    cradle::Segments<Law, Chain> segments(cradle::workers(executor), {.steps = cradle::fastest_steps()});
    run.advance(until, segments);
  });
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fprintf(stderr, "usage: %s PARTICLES UNTIL\n", arguments[0]), 2;
  const std::uint64_t particles = std::strtoull(arguments[1], nullptr, 10);
  const double until = std::strtod(arguments[2], nullptr);
  measure("plain", particles, CLOCK_THREAD_CPUTIME_ID, [&](Run& run) { run.advance(until); });
  measure_segments("segments", particles, until, 1);
  measure_segments("two_threads", particles, until, 2);
}
