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

// In segments on so many threads; 0: by the plain loop.
void measure(const char* engine, cradle::ParticleIndex particles, double until, unsigned threads) {
  cradle::Simulation run(Law(1, 0), Chain(bench::gas(particles, heavier, static_cast<double>(particles)), 0.));
  const auto advance = [&] {
    if (threads == 0) return run.advance(until);
    cradle::TbbExecutor executor(threads);
    cradle::Segments<Law, Chain> segments(cradle::workers(executor), {.steps = cradle::fastest_steps()});
    return run.advance(until, segments);
  };
  const double seconds = bench::seconds_of(advance, threads > 1 ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID);
  std::printf("%s %llu %.4f\n", engine, static_cast<unsigned long long>(run.counts().collisions), seconds);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fprintf(stderr, "usage: %s PARTICLES UNTIL\n", arguments[0]), 2;
  const cradle::ParticleIndex particles = std::strtoll(arguments[1], nullptr, 10);
  const double until = std::strtod(arguments[2], nullptr);
  measure("plain", particles, until, 0);
  measure("segments", particles, until, 1);
  measure("two_threads", particles, until, 2);
}
