// What an ensemble costs in addition to its runs, and what threads gain.
//
//   cmake --preset release && cmake --build --preset release --target bench_ensemble
//   build/release/bench/bench_ensemble --benchmark_enable_random_interleaving=true --benchmark_repetitions=5
//                                      --benchmark_report_aggregates_only=true
//
// wet   replicas of 1e4 particles, E_loss = 0.05, to t = 9900, 101 samples (30,000 collisions each)
// dry   replicas of the bundled scene fig2 to t = 4000, 101 samples (4.7 million collisions each)
//
// runs          as `cradle run` makes them, one after the other; results are dropped
// ensemble/T    as `cradle ensemble --threads T`: journal, statistics, file
//
// small/N   a ring of N particles, Gaussian velocities, restitution 0.9, cut-off 1e-6, to t = 10: the column "each" is
//           the processor time of a replica (--benchmark_filter=small)
//   plain     a loop that scans all gaps for the next collision, and two samples of the energy
//   engine    Cradle's engine, without samples
//   ensemble  as `cradle ensemble --threads 1`, two samples: journal, statistics, file
//
// Times are by the clock: use an idle machine, and compare ratios of medians.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common.hpp"
#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace {

namespace tools = cradle::tools;

// With the time of a replica beside that of all.
auto* enter(const std::string& name, int replicas, const std::function<void()>& all) {
  const auto measure = [=](benchmark::State& state) {
    using benchmark::Counter;
    for (auto iteration : state) all();
    state.counters["each"] = Counter(replicas, Counter::kIsIterationInvariantRate | Counter::kInvert);
  };
  return benchmark::RegisterBenchmark(name.c_str(), measure)->Unit(benchmark::kMillisecond);
}

// ---- the program

void run_ensemble(const tools::Scene& scene, int replicas, unsigned threads) {
  const auto file = std::filesystem::temp_directory_path() / "cradle-bench-ensemble.h5";
  std::filesystem::remove(file);
  tools::EnsembleOptions options;
  options.replicas = {0, static_cast<std::uint64_t>(replicas)};
  options.threads = threads;
  options.progress = tools::ProgressLine::Show::never;
  tools::Interrupt interrupt;
  tools::OneProcess alone(interrupt);
  tools::run_study(tools::ensemble_of(scene), options, file, alone);
  std::filesystem::remove(file);
}

void enter_scene(const std::string& of, const tools::Scene& scene, int replicas) {
  enter(of + "/runs", replicas, [=] {
    tools::Scene replica = scene;
    for (int k = 0; k < replicas; ++k) {
      replica.initial.replica = static_cast<std::uint64_t>(k);
      benchmark::DoNotOptimize(tools::run_scene(replica, {tools::ProgressLine::Show::never}));
    }
  })->UseRealTime();
  for (const unsigned threads : {1U, 2U})
    enter(of + "/ensemble/" + std::to_string(threads), replicas, [=] {
      run_ensemble(scene, replicas, threads);
    })->UseRealTime();
}

// ---- many small systems

constexpr double restitution = 0.9, cutoff = 1e-6, until = 10;

// What one would write by hand. Returns the energy, and adds the collisions.
double plain_loop(int n, int replica, std::uint64_t& collisions) {
  const auto count = static_cast<std::size_t>(n);
  std::vector<double> v(count), gap(count, 1.);
  double mean = 0;
  for (std::size_t i = 0; i < count; ++i)  // Marsaglia's polar method
    for (std::uint64_t attempt = 1; v[i] == 0; ++attempt) {
      const std::uint64_t bits = cradle::random_bits(0, static_cast<std::uint64_t>(replica), i | attempt << 56);
      const double x = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-31 - 1;
      const double y = (static_cast<double>(bits & 0xFFFFFFFF) + 0.5) * 0x1p-31 - 1, square = x * x + y * y;
      if (square < 1) v[i] = x * std::sqrt(-2 * std::log(square) / square);
    }
  for (const double each : v) mean += each / n;
  for (double& each : v) each -= mean;
  const auto closing = [&](std::size_t i) { return v[i] - v[i + 1 < count ? i + 1 : 0]; };
  const auto energy = [&] {
    double sum = 0;
    for (const double each : v) sum += each * each / 2;
    return sum;
  };
  benchmark::DoNotOptimize(energy());
  for (double left = until;;) {
    double next = left;
    std::size_t hit = count;
    for (std::size_t i = 0; i < count; ++i)
      if (closing(i) > 0 && gap[i] / closing(i) < next) next = gap[i] / closing(i), hit = i;
    if (hit == count) return energy();
    for (std::size_t i = 0; i < count; ++i) gap[i] -= closing(i) * next;
    const double w = closing(hit), handed = (1 + (w < cutoff ? 1 : restitution)) / 2 * w;
    v[hit] -= handed, v[hit + 1 < count ? hit + 1 : 0] += handed;
    gap[hit] = 0;
    left -= next;
    ++collisions;
  }
}

double engine_alone(int n, int replica, std::uint64_t& collisions) {
  const auto ring = std::make_shared<cradle::Ring<double>>(
      n, static_cast<double>(n), 1., cradle::gaussian_velocity(0, static_cast<std::uint64_t>(replica)),
      cradle::uniform_displacement(0, 0, 0));
  cradle::Simulation run(cradle::Inelastic<double>(restitution, cutoff), cradle::GapChain<double>(ring, 0.));
  run.advance(until);
  collisions += run.counts().collisions;
  return run.kinetic_energy(until);
}

void enter_small(int n) {
  const int replicas = 300'000 / (n + 10);
  const auto enter_each = [=](const std::string& name, const std::function<void()>& all) {
    enter("small/" + std::to_string(n) + "/" + name, replicas, all)->MeasureProcessCPUTime();
  };
  for (const auto& [name, run] : {std::pair{"plain", &plain_loop}, {"engine", &engine_alone}})
    enter_each(name, [=, run = run] {
      static std::map<int, std::uint64_t> expected;  // rounding moves one of thousands across the end
      std::uint64_t collisions = 0;
      double energy = 0;
      for (int k = 0; k < replicas; ++k) energy += run(n, k, collisions);
      benchmark::DoNotOptimize(energy);
      const std::uint64_t others = expected.try_emplace(n, collisions).first->second;
      if (std::abs(static_cast<double>(collisions) / static_cast<double>(others) - 1) < 1e-3) return;
      std::fprintf(stderr, "small/%d: the engines do not agree: times mean nothing\n", n);
      std::exit(1);
    });
  const tools::Scene scene = tools::parse_scene(
      "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-6 }\nrun.until = 10\noutput.series.points = 2\n"
      "initial = { type = 'ring', particles = " +
          std::to_string(n) + ", length = " + std::to_string(n) + ", variance = 1, seed = 0 }\n",
      "small.toml");
  enter_each("ensemble", [=] { run_ensemble(scene, replicas, 1); });
}

void enter_all() {
  const tools::Scene wet =
      tools::parse_scene("law = { type = 'wet', loss = 0.05 }\nrun.until = 9900\noutput.series.points = 101\n"
                         "initial = { type = 'rows', particles = 1e4, speed = 0.5, perturbation = 0.05 }\n",
                         "wet.toml");
  const tools::Scene dry = tools::read_scene(
      "fig2", {"run.until=4000", "output.series.points=101", "output.snapshots=", "output.profiles.times="});
  enter_scene("wet", wet, 8000);
  enter_scene("dry", dry, 8);
  for (const int n : {3, 10, 30, 100, 1000}) enter_small(n);
}

}  // namespace

int main(int argc, char** argv) { return bench::measure_all(argc, argv, enter_all); }
