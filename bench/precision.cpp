// Run time against error on the same work, for every scalar type in gaps and in absolute positions.
//
//   cmake --preset release && cmake --build --preset release --target bench_precision
//   build/release/bench/bench_precision --csv=precision.csv        (five minutes; parts of it: --benchmark_filter)
//   bench/plot_precision.py precision.csv bench/pictures/precision.png
//
// collapse   three and four particles: collapse time against its closed form, collisions until the gap is wrong
// shock      N = 1000 into the collapsed cluster: energy, front and gaps against 230 digits, first collision out of
//            order
// order      N = 8000 to t = 6500, the paper's Fig. 3: the same against 100 digits, for the faster types
// speed      N = 8000 to t = 4000: collisions per second, also of conventional engines in double (twins/)
// reversal   elastic gas forwards and back: rounding errors alone
//
// Errors are relative and at most 1. The CSV has a line per number: scene, representation, type, quantity, t, value.
// Times are processor time of the thread.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "measured.hpp"
#include "precision/collapse.hpp"
#include "precision/engines.hpp"
#include "precision/reversal.hpp"
#include "precision/shock.hpp"
#include "twins/queues.hpp"

namespace {

using namespace precision;

const ShockScene shock{"shock", 1000, "0.992", {500, 750, 812.5, 817}, 3'145'851};
const ShockScene order{"order", 8000, "0.999", {4000, 6000, 6500}, 34'679'181};
const ShockScene speed{"speed", 8000, "0.999", {4000}, 4'685'816};

// ---- results, for the file and for Google Benchmark's table

class Report {
 public:
  Report(benchmark::State& state, const std::string& scene, const std::string& representation, const std::string& type)
      : state_(state), of_(scene + ',' + representation + ',' + type + ',') {}

  void add(const std::string& quantity, double value, const std::string& time = "") {
    state_.counters[counter(quantity) + (time.empty() ? "" : "@" + time)] =
        counter(quantity) == quantity ? value : -std::log10(value);
    rows()[of_ + quantity + ',' + time] = value;
  }
  void cost(double seconds, std::uint64_t collisions) {
    state_.SetIterationTime(seconds);
    add("collisions", static_cast<double>(collisions));
    add("ns_per_collision", 1e9 * seconds / static_cast<double>(collisions));
    state_.counters["collisions/s"] = static_cast<double>(collisions) / seconds;
  }

  static void write(const std::string& path) {
    std::ofstream file(path);
    file << "scene,representation,type,quantity,t,value\n";
    for (const auto& [key, value] : rows()) file << key << ',' << cradle::to_text(value) << '\n';
    if (!file.flush())
      throw std::runtime_error(path + " cannot be written: give a path in a folder that you may write to");
  }

 private:
  static std::map<std::string, double>& rows() {
    static std::map<std::string, double> rows;
    return rows;
  }

  // Google Benchmark cannot print 1e-30: an error is shown as the number of right digits.
  static std::string counter(const std::string& quantity) {
    constexpr std::string_view error = "error";
    return quantity.ends_with(error) ? quantity.substr(0, quantity.size() - error.size()) + "digits" : quantity;
  }

  benchmark::State& state_;
  std::string of_;
};

Report report(benchmark::State& state, const std::string& scene, const Engine& engine) {
  return {state, scene, engine.representation(), engine.type()};
}

// ---- one function per measurement

void measure_collapse(benchmark::State& state, const Engine& engine, const CollapseScene& scene) {
  const CollapseOutcome outcome = measure(engine, scene);
  Report found = report(state, scene.name, engine);
  found.cost(outcome.seconds, outcome.collisions);
  found.add("time_error", outcome.extrapolated);
  found.add("claimed_time_error", outcome.claimed);
  found.add("summed_time_error", outcome.summed);
  found.add("collisions_right", static_cast<double>(outcome.collisions_right));
}

void measure_reversal(benchmark::State& state, const Engine& engine) {
  const ReversalOutcome outcome = reverse(engine);
  Report found = report(state, "reversal", engine);
  found.cost(outcome.seconds, outcome.collisions);
  found.add("position_error", outcome.error);
}

void add_errors(Report& found, const ShockScene& scene, const ShockRun& run, const ShockRun& exact) {
  for (std::size_t k = 0; k < scene.times.size(); ++k) {
    const ShockErrors e = errors(run.states[k], exact.states[k]);
    const std::string time = cradle::to_text(scene.times[k]);
    found.add("gap_error", e.gaps, time);
    found.add("energy_error", e.energy, time);
    found.add("front_error", e.front, time);
  }
}

// The number of collisions of the reference, and the time up to which their order is right; all collisions if it is
// right to the end.
void add_order(Report& found, const ShockScene& scene, const ShockRun& run, const ShockRun& exact) {
  const auto agreed = last_agreement(exact.samples, run.samples);
  const Sample last = agreed.value_or(exact.samples.back());
  found.add("order_right_collisions", static_cast<double>(last.collisions));
  found.add("order_right_time", last.time);
  found.add("order_wrong", agreed ? 1 : 0);
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
  Report found = report(state, shock.name, engine);
  found.cost(plain.seconds, plain.states.back().collisions);
  add_errors(found, shock, plain, exact.run);
  add_order(found, shock, run(engine, shock, exact.sampling), exact.run);
}

void measure_order(benchmark::State& state, const Engine& engine) {
  static const Reference exact(order, 100);
  const ShockRun traced = run(engine, order, exact.sampling);
  Report found = report(state, order.name, engine);
  state.SetIterationTime(traced.seconds);
  found.add("collisions", static_cast<double>(traced.states.back().collisions));
  add_errors(found, order, traced, exact.run);
  add_order(found, order, traced, exact.run);
}

template <class Once> void measure_speed(benchmark::State& state, Report found, Once once) {
  std::uint64_t collisions = 0;
  double best = once(collisions);
  for (int trial = 0; trial < 4 && best < 1; ++trial) best = std::min(best, once(collisions));
  found.cost(best, collisions);
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
    measure_speed(state, Report(state, speed.name, "conventional", name),
                  [](std::uint64_t& collisions) { return time_twin<Queue>(speed, collisions); });
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
      measure_speed(state, report(state, speed.name, engine),
                    [&](std::uint64_t& collisions) { return time_engine(engine, speed, collisions); });
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

int main(int argc, char** argv) try {
  benchmark::Initialize(&argc, argv);
  constexpr std::string_view option = "--csv=";
  std::string csv;
  if (argc == 2 && std::string_view(argv[1]).starts_with(option)) {
    csv = argv[1] + option.size();
    argc = 1;
  }
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  enter_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  if (!csv.empty()) Report::write(csv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
