// Run time against error on the same work, for every scalar type in gaps and in absolute positions.
//
//   cmake --preset release && cmake --build --preset release --target bench_precision
//   build/release/bench/bench_precision --benchmark_out=precision.json --benchmark_out_format=json
//   bench/plot_precision.py precision.json bench/pictures/precision.png
//
// collapse   three and four particles: collapse time against its closed form, collisions until the gap is wrong
// shock      N = 1000 into the collapsed cluster: energy, front and gaps against 230 digits, first collision out of
//            order
// order      N = 8000 to t = 6500, the paper's Fig. 3: the same against 100 digits, for the faster types
// speed      N = 8000 to t = 4000: collisions per second, also of conventional engines in double (twins/)
// reversal   elastic gas forwards and back: rounding errors alone
//
// It takes five minutes. Errors are relative and at most 1, and entered as the number of right digits, -log10, since
// Google Benchmark's table cannot print 1e-30. Times are processor time of the thread.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

#include "common.hpp"
#include "precision/engines.hpp"
#include "precision/known_ends.hpp"
#include "precision/shock.hpp"
#include "twins/engines.hpp"

namespace {

using namespace precision;

const ShockScene shock{"shock", 1000, "0.992", {500, 750, 812.5, 817}, 3'145'851};
const ShockScene order{"order", 8000, "0.999", {4000, 6000, 6500}, 34'679'181};
const ShockScene speed{"speed", 8000, "0.999", {4000}, 4'685'816};

// ---- results

void add(benchmark::State& state, const std::string& quantity, double value, double time = 0) {
  state.counters[quantity + (time > 0 ? "@" + cradle::to_text(time) : "")] = value;
}
void add_digits(benchmark::State& state, const std::string& of, double error, double time = 0) {
  add(state, of + "_digits", -std::log10(error), time);
}
void cost(benchmark::State& state, double seconds, std::uint64_t collisions) {
  state.SetIterationTime(seconds);
  const auto count = static_cast<double>(collisions);
  add(state, "collisions", count);
  add(state, "ns_per_collision", 1e9 * seconds / count);
  add(state, "collisions/s", count / seconds);
}

// ---- one function per measurement

void measure_collapse(benchmark::State& state, const Engine& engine, const CollapseScene& scene) {
  const CollapseOutcome outcome = measure(engine, scene);
  cost(state, outcome.seconds, outcome.collisions);
  add_digits(state, "time", outcome.extrapolated);
  add_digits(state, "claimed_time", outcome.claimed);
  add_digits(state, "summed_time", outcome.summed);
  add(state, "collisions_right", static_cast<double>(outcome.collisions_right));
}

void measure_reversal(benchmark::State& state, const Engine& engine) {
  const ReversalOutcome outcome = reverse(engine);
  cost(state, outcome.seconds, outcome.collisions);
  add_digits(state, "position", outcome.error);
}

void add_errors(benchmark::State& state, const ShockScene& scene, const ShockRun& run, const ShockRun& exact) {
  for (std::size_t k = 0; k < scene.times.size(); ++k) {
    const ShockErrors e = errors(run.states[k], exact.states[k]);
    add_digits(state, "gap", e.gaps, scene.times[k]);
    add_digits(state, "energy", e.energy, scene.times[k]);
    add_digits(state, "front", e.front, scene.times[k]);
  }
}

// The number of collisions of the reference, and the time up to which their order is right; all collisions if it is
// right to the end.
void add_order(benchmark::State& state, const ShockScene& scene, const ShockRun& run, const ShockRun& exact) {
  const auto agreed = last_agreement(exact.samples, run.samples);
  const Sample last = agreed.value_or(exact.samples.back());
  add(state, "order_right_collisions", static_cast<double>(last.collisions));
  add(state, "order_right_time", last.time);
  add(state, "order_wrong", agreed ? 1 : 0);
  if (exact.states.back().collisions / samples != scene.collisions / samples)
    std::fprintf(stderr,
                 "%s: %llu collisions in the reference run (expected about %llu): samples are spaced otherwise\n",
                 scene.name.c_str(), static_cast<unsigned long long>(exact.states.back().collisions),
                 static_cast<unsigned long long>(scene.collisions));
}

// The traced reference run of a scene, and its sampling times.
struct Reference {
  std::vector<double> sampling;
  ShockRun run;
  Reference(const ShockScene& scene, unsigned digits)
      : sampling(sampling_times(scene)), run(precision::run(reference(digits), scene, sampling)) {}
};

void measure_shock(benchmark::State& state, const Engine& engine) {
  static const Reference exact(shock, 230);
  ShockRun plain = run(engine, shock);
  for (int trial = 0; trial < 2 && plain.seconds < 1; ++trial)
    plain.seconds = std::min(plain.seconds, run(engine, shock).seconds);
  cost(state, plain.seconds, plain.states.back().collisions);
  add_errors(state, shock, plain, exact.run);
  add_order(state, shock, run(engine, shock, exact.sampling), exact.run);
}

void measure_order(benchmark::State& state, const Engine& engine) {
  static const Reference exact(order, 100);
  const ShockRun traced = run(engine, order, exact.sampling);
  state.SetIterationTime(traced.seconds);
  add(state, "collisions", static_cast<double>(traced.states.back().collisions));
  add_errors(state, order, traced, exact.run);
  add_order(state, order, traced, exact.run);
}

template <class Once> void measure_speed(benchmark::State& state, Once once) {
  std::uint64_t collisions = 0;
  double best = once(collisions);
  for (int trial = 0; trial < 4 && best < 1; ++trial) best = std::min(best, once(collisions));
  cost(state, best, collisions);
  if (collisions != speed.collisions) state.SkipWithError("counts other collisions than it must: times mean nothing");
}

double time_engine(const Engine& engine, const ShockScene& scene, std::uint64_t& collisions) {
  return with_chain<double>(engine, [&]<class Chain>(std::type_identity<Chain>) {
    Run<Chain> simulation = prepare<Chain>(scene);
    const double seconds = bench::seconds_of([&] { simulation.advance(typename Chain::Scalar(scene.times.back())); });
    collisions = simulation.counts().collisions;
    return seconds;
  });
}

template <class Queue> double time_twin(const ShockScene& scene, std::uint64_t& collisions) {
  twins::QueueEngine<Queue> twin(*bench::rows<double>(scene.particles), {0.999, 1e-5});
  const double seconds = bench::seconds_of([&] { twin.advance(scene.times.back()); });
  collisions = twin.collisions();
  return seconds;
}

// ---- list of measurements

template <class Measure> void enter(const std::string& name, const Measure& measure) {
  const auto once = [=](benchmark::State& state) {
    for (auto iteration : state) measure(state);
  };
  bench::enter_timed(name, once)->Iterations(1);
}

template <class Queue> void enter_twin(const std::string& name) {
  enter("speed/conventional/" + name, [=](benchmark::State& state) {
    measure_speed(state, [](std::uint64_t& collisions) { return time_twin<Queue>(speed, collisions); });
  });
}

void enter_all() {
  std::vector<Engine> engines;
  for (const bool gaps : {true, false})
    for (const cradle::ScalarChoice& scalar : scalars()) engines.push_back({scalar, gaps});
  for (const CollapseScene& scene : collapse_scenes())
    for (const Engine& engine : engines)
      enter("collapse/" + scene.name + "/" + engine.name(),
            [=](benchmark::State& state) { measure_collapse(state, engine, scene); });
  for (const Engine& engine : engines)
    enter("reversal/" + engine.name(), [=](benchmark::State& state) { measure_reversal(state, engine); });
  enter_twin<twins::TunedHeap>("tuned_heap");
  enter_twin<twins::IndexedHeap>("indexed_heap");
  for (const Engine& engine : engines)
    enter("speed/" + engine.name(), [=](benchmark::State& state) {
      measure_speed(state, [&](std::uint64_t& collisions) { return time_engine(engine, speed, collisions); });
    });
  for (const Engine& engine : engines)
    enter("shock/" + engine.name(), [=](benchmark::State& state) { measure_shock(state, engine); });
  for (const Engine& engine : engines) {
    const std::string& type = engine.scalar.name;
    if (type == "double" || type == "long double" || type == "double-double" || (type == "float128" && engine.gaps))
      enter("order/" + engine.name(), [=](benchmark::State& state) { measure_order(state, engine); });
  }
}

}  // namespace

int main(int argc, char** argv) { return bench::measure_all(argc, argv, enter_all); }
