// What an ensemble costs in addition to its runs, what threads gain, and whether it is faster to interleave two
// replicas collision by collision in one thread than to run one after the other.
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
// in_turn, interleaved   engines without samples
//
// Times are by the clock: use an idle machine, and compare ratios of medians.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace {

namespace tools = cradle::tools;

void enter(const std::string& name, int replicas, const std::function<void()>& all) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 for (auto iteration : state) all();
                                 state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * replicas);
                               })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

// ---- the program

void enter_scene(const std::string& of, const tools::Scene& scene, int replicas) {
  enter(of + "/runs", replicas, [=] {
    tools::Scene replica = scene;
    for (int k = 0; k < replicas; ++k) {
      replica.initial.replica = static_cast<std::uint64_t>(k);
      benchmark::DoNotOptimize(tools::run_scene(replica, {tools::ProgressLine::Show::never}));
    }
  });
  for (const unsigned threads : {1U, 2U})
    enter(of + "/ensemble/" + std::to_string(threads), replicas, [=] {
      const auto file = std::filesystem::temp_directory_path() / "cradle-bench-ensemble.h5";
      std::filesystem::remove(file);
      tools::EnsembleOptions options;
      options.replicas = {0, static_cast<std::uint64_t>(replicas)};
      options.threads = threads;
      options.progress = tools::ProgressLine::Show::never;
      tools::run_ensemble(scene, options, file);
      std::filesystem::remove(file);
    });
}

// ---- engines

std::shared_ptr<const cradle::Particles<double>> rows(cradle::ParticleIndex particles, int replica) {
  const auto displacement = cradle::uniform_displacement(0.05, 1, static_cast<std::uint64_t>(replica));
  return std::make_shared<cradle::Rows<double>>(cradle::symmetric_rows(particles, 0.5, 1.0, displacement));
}

template <class Simulation> void advance_both(Simulation& a, Simulation& b, double until) {
  a.head_for(until);
  b.head_for(until);
  while (a.step() && b.step()) {
  }
  a.advance(until);
  b.advance(until);
}

template <class Make> void enter_engine(const std::string& of, int replicas, double until, Make make) {
  const auto lost = std::make_shared<double>(0);  // of all replicas: its bits do not depend on the order
  const auto check = [=](double sum) {
    if (*lost == 0) *lost = sum;
    if (*lost == sum) return;
    std::fprintf(stderr, "%s: replicas differ when interleaved: times mean nothing\n", of.c_str());
    std::exit(1);
  };
  enter(of + "/in_turn", replicas, [=] {
    double sum = 0;
    for (int k = 0; k < replicas; ++k) {
      auto one = make(k);
      one.advance(until);
      sum += one.energy_lost();
    }
    check(sum);
  });
  enter(of + "/interleaved", replicas, [=] {
    double sum = 0;
    for (int k = 0; k < replicas; k += 2) {
      auto a = make(k), b = make(k + 1);
      advance_both(a, b, until);
      sum += a.energy_lost();
      sum += b.energy_lost();
    }
    check(sum);
  });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  const tools::Scene wet = tools::parse_scene(R"(
    law = { type = "wet", loss = 0.05 }
    initial = { type = "rows", particles = 1e4, speed = 0.5, perturbation = 0.05 }
    run = { until = 9900 }
    output = { series = { points = 101 } }
  )",
                                              "wet.toml");
  const tools::Scene dry = tools::read_scene(
      "fig2", {"run.until=4000", "output.series.points=101", "output.snapshots=", "output.profiles.times="});
  enter_scene("wet", wet, 8000);
  enter_scene("dry", dry, 8);
  enter_engine("wet", 400, 9900, [](int replica) {
    return cradle::Simulation(cradle::Wet<double>(0.05), cradle::ClusterChain<double>(rows(10'000, replica), 0.0));
  });
  enter_engine("dry", 4, 4000, [](int replica) {
    return cradle::Simulation(cradle::Inelastic<double>(0.999, 1e-5),
                              cradle::GapChain<double>(rows(8000, replica), 0.0));
  });
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
