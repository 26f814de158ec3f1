// Collisions per second of Cradle's engine, in gaps and in absolute positions, and of conventional engines in double
// (twins/). Compare the ratios within one run: there the machine and the collisions are the same.
//
//   cmake --preset release && cmake --build --preset release --target bench_engine
//   build/release/bench/bench_engine --benchmark_repetitions=3 --benchmark_report_aggregates_only=true
//
// shock   two rows of N particles together, eps = 0.999, delta = 1e-5, as in the paper's Fig. 2; `collisions/s` over
//         the whole run, `late/s` over its end (6000 to 6500 for N = 8000), when the dense cluster forms. The far
//         particles of long rows are not met yet: Cradle streams them.
// gas     N particles of random velocities, all of them active from the start, eps = 0.999; up to 300 particles every
//         run is another one, since the processor learns the jumps of a run that is repeated.
//
// Times are processor time of the thread (time by the clock for the run on two threads), so that other work on the
// machine disturbs them less. All engines must count the same collisions; otherwise the program prints an error and
// ends with status 1.

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "twins/engines.hpp"

namespace {

using namespace bench;

constexpr twins::Law law{0.999, 1e-5};

// ---- engines with the interface of twins/

template <class Chain> class Cradle {
 public:
  Cradle(const ParticlesPointer& particles)
      : simulation_(cradle::Inelastic<double>(law.restitution, law.cutoff), Chain(particles, 0.0)) {}
  void advance(double until) { simulation_.advance(until); }
  std::uint64_t collisions() const { return simulation_.counts().collisions; }

 protected:
  cradle::Simulation<double, cradle::Inelastic<double>, Chain> simulation_;
};
using Gaps = Cradle<cradle::GapChain<double>>;
using Positions = Cradle<cradle::PositionChain<double>>;

// A run in segments and steps (core/parallel/), as programs have it, on so many threads. `parallel` says how evenly
// segments share the work: all collisions divided by those of the largest segment, in each time slab.
template <unsigned threads> class InSegments : public Gaps {
 public:
  InSegments(const ParticlesPointer& particles)
      : Gaps(particles), executor_(threads), segments_(cradle::workers(executor_), {.steps = cradle::fastest_steps()}) {
  }
  void advance(double until) { simulation_.advance(until, segments_); }
  const auto& statistics() const { return segments_.statistics(); }

 private:
  cradle::TbbExecutor executor_;
  cradle::Segments<cradle::Inelastic<double>, cradle::GapChain<double>> segments_;
};

template <class Engine> struct Twin : Engine {
  Twin(const ParticlesPointer& particles) : Engine(*particles, law) {}
};
template <class Queue> using WithQueue = Twin<twins::QueueEngine<Queue>>;

// ---- measurements

// For check(): with 0 the collisions are those of the first engine.
struct Check {
  double time;
  std::uint64_t collisions;
};

struct Case {
  std::string name;
  std::function<ParticlesPointer(std::uint64_t run)> particles;
  std::vector<Check> checks;  // a run ends with the last
  bool small = false;
};

template <class Engine>
constexpr clockid_t clock_of = std::same_as<Engine, InSegments<2>> ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID;

template <class Engine> void measure(benchmark::State& state, const Case& c, const std::string& engine_name) {
  double late_seconds = 0;
  std::uint64_t collisions = 0, late_collisions = 0, runs = 0;
  for (auto iteration : state) {
    const ParticlesPointer particles = c.particles(runs);
    const std::string run = c.name + "/" + std::to_string(runs++);
    Engine engine(particles);
    double seconds = 0;
    std::uint64_t before = 0;
    double last = 0;
    for (const Check& at : c.checks) {
      before = engine.collisions();
      last = seconds_of([&] { engine.advance(at.time); }, clock_of<Engine>);
      seconds += last;
      check(run, engine_name, at.time, engine.collisions(), at.collisions);
    }
    collisions += engine.collisions();
    if constexpr (requires { engine.statistics(); }) {
      const auto& s = engine.statistics();
      state.counters["slabs"] = static_cast<double>(s.slabs);
      state.counters["given_up"] = static_cast<double>(s.given_up);
      state.counters["again"] = static_cast<double>(s.again);
      if (s.largest > 0)
        state.counters["parallel"] = static_cast<double>(s.collisions) / static_cast<double>(s.largest);
    }
    late_collisions += engine.collisions() - before;
    late_seconds += last;
    state.SetIterationTime(seconds);
  }
  count(state, collisions);
  state.counters["late/s"] = static_cast<double>(late_collisions) / late_seconds;
}

template <class Engine> void enter(const std::string& engine, const std::shared_ptr<const Case>& c) {
  enter_timed(c->name + "/" + engine, [=](benchmark::State& state) { measure<Engine>(state, *c, engine); });
}

void enter_case(const Case& c) {
  const auto shared = std::make_shared<const Case>(c);
  enter<Gaps>("cradle_gaps", shared);
  enter<InSegments<1>>("cradle_segments", shared);
  enter<InSegments<2>>("cradle_two_threads", shared);
  enter<Positions>("cradle_positions", shared);
  enter<Twin<twins::TimeSlotsEngine>>("time_slots", shared);
  enter<WithQueue<twins::TunedHeap>>("tuned_heap", shared);
  enter<WithQueue<twins::IndexedHeap>>("indexed_heap", shared);
  if (c.small) enter<WithQueue<twins::Scan>>("scan", shared);
}

void enter_all() {
  // Counts up to 6000 are those of an independent program, the same in double, binary128 and 100 digits. Soon after
  // 6500, positions in double no longer resolve the cluster, and counts begin to differ.
  const auto always = [](const ParticlesPointer& particles) { return [=](std::uint64_t) { return particles; }; };
  enter_case({"shock/8000",
              always(rows<double>(8000)),
              {{999.5, 384155}, {1999, 1299216}, {4000, 4685816}, {6000, 16156905}, {6500, 0}}});
  for (const ParticleIndex n : {100'000, 1'000'000})
    enter_case({"shock/" + std::to_string(n), always(rows<double>(n)), {{2000, 0}, {4000, 0}}});
  for (const ParticleIndex n : {3, 10, 30, 100, 300})
    enter_case({"gas/" + std::to_string(n), [=](std::uint64_t run) { return gas(n, 1, 0., run); }, {{300, 0}}, true});
  const std::pair<ParticleIndex, double> gases[] = {
      {1000, 300}, {8000, 300}, {100'000, 40}, {1'000'000, 40}, {10'000'000, 20}};
  for (const auto& [n, until] : gases)
    enter_case({"gas/" + std::to_string(n), always(gas(n)), {{until / 2, 0}, {until, 0}}});
}

}  // namespace

int main(int argc, char** argv) { return bench::measure_all(argc, argv, enter_all); }
