// Collisions per second with particles that merge or pass through each other, wet and sticky, and of a conventional
// engine in absolute coordinates (twins/engines.hpp). Compare the ratios within one run.
//
//   cmake --preset release && cmake --build --preset release --target bench_merging
//   build/release/bench/bench_merging --benchmark_repetitions=3 --benchmark_report_aggregates_only=true
//
// shock    the paper's wet shocks, Fig. 6 (N = 5e4, E_loss = 1e-4, to t = 12000) and Fig. 11 (N = 2e7, E_loss = 0.05,
//          to 1.9e7; and rows of 55,000 to 1e5, since the conventional engine holds every particle). Counts are the
//          published ones.
// cooling  N particles on a ring, Gaussian velocities of variance 1, to t = 1000.
//
// Times are processor time of the thread, with two threads time by the clock.

#include <memory>
#include <string>

#include "common.hpp"
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "twins/engines.hpp"

namespace {

using namespace bench;

ParticlesPointer ring(cradle::ParticleIndex n) {
  return std::make_shared<cradle::Ring<double>>(n, static_cast<double>(n), 1.0, cradle::gaussian_velocity(1, 0),
                                                cradle::uniform_displacement(0, 1, 0));
}

struct Measured {
  const char* engine;
  std::uint64_t (*run)(const ParticlesPointer& particles, double loss, double until);  // returns the collisions
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
};

// In segments on so many threads; 0: by the plain loop.
template <unsigned threads> std::uint64_t run_cradle(const ParticlesPointer& particles, double loss, double until) {
  const auto made = [&]<class Law>(const Law& law) {
    using Chain = cradle::ClusterChain<double>;
    cradle::Simulation engine(law, Chain(particles, 0.0));
    if constexpr (threads == 0) {
      engine.advance(until);
    } else {
      const cradle::TbbExecutor executor(threads);
      cradle::Segments<Law, Chain> segments(cradle::workers(executor), {.steps = cradle::fastest_steps()});
      engine.advance(until, segments);
    }
    return engine.counts().collisions;
  };
  return loss < 0 ? made(cradle::Sticky<double>{}) : made(cradle::Wet<double>(loss));
}
std::uint64_t run_twin(const ParticlesPointer& particles, double loss, double until) {
  twins::MergingEngine engine(*particles, loss);
  engine.advance(until);
  return engine.collisions();
}
constexpr Measured plain{"cradle", run_cradle<0>}, in_segments{"cradle_segments", run_cradle<1>},
    on_two_threads{"cradle_two_threads", run_cradle<2>, CLOCK_MONOTONIC}, conventional{"conventional", run_twin};

// The time includes the set-up: it is part of a run's cost, and conventional engines set up every particle of the rows.
void enter(const std::string& of, const Measured& measured, const ParticlesPointer& particles, double loss,
           double until, std::uint64_t published = 0) {
  enter_timed(of + "/" + measured.engine, [=](benchmark::State& state) {
    std::uint64_t collisions = 0;
    for (auto iteration : state) {
      std::uint64_t made = 0;
      state.SetIterationTime(seconds_of([&] { made = measured.run(particles, loss, until); }, measured.clock));
      check(of, measured.engine, until, made, published);
      collisions += made;
    }
    count(state, collisions);
  });
}

void enter_all() {
  for (const Measured& engine : {plain, in_segments, on_two_threads, conventional})
    enter("wet/fig6", engine, rows<double>(50'000), 1e-4, 12000, 12153997);
  for (const Measured& engine : {plain, in_segments})
    enter("wet/fig11", engine, rows<double>(20'000'000), 0.05, 1.9e7, 57079264);
  enter("wet/fig11_begin", plain, rows<double>(110'000), 0.05, 1e5);
  enter("wet/fig11_begin", conventional, rows<double>(110'000), 0.05, 1e5);
  for (const cradle::ParticleIndex n : {100, 1000, 10'000, 100'000, 1'000'000}) {
    const ParticlesPointer particles = ring(n);
    for (const double loss : {-1.0, 0.1}) {
      const std::string of = (loss < 0 ? "sticky/cooling/" : "wet/cooling/") + std::to_string(n);
      for (const Measured& engine : {plain, in_segments, on_two_threads, conventional})
        enter(of, engine, particles, loss, 1000);
    }
  }
}

}  // namespace

int main(int argc, char** argv) { return bench::measure_all(argc, argv, enter_all); }
