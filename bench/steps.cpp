// Collisions in steps of time (core/parallel/steps) and in the event loop, both in segments on one thread. Pieces of
// the two runs alternate, so that both see the same machine. The collisions and the energy lost must be the same to the
// bit; otherwise the program prints an error and ends with status 1.
//
//   cmake --preset release && cmake --build --preset release --target bench_steps
//   build/release/bench/bench_steps [CASE...]
//   build/release/bench/bench_steps threads
//   valgrind --tool=callgrind --toggle-collect='*by_steps*' build/release/bench/bench_steps gas/1000
//
// The second one compares steps on two threads with steps on one, by the clock; beside it stands what the memory of the
// machine allows: both copy as many gaps. The third one counts the instructions of steps alone (with `by_loop`: of the
// event loop), on the vectors that valgrind knows.
//
// Cases are those of bench/engine.cpp, which become thinner, and gases with masses 1 and 3, between walls, and with a
// restitution that depends on the speed, in which clusters collapse; then gases on rings, which stay as dense as they
// are: elastic ones, and one with a restitution near 1 that depends on the speed. `wide` ones are in double-double.
// Times are processor time of the thread. `late` is the last thirteenth of the time: 6000 to 6500 for the shock.

#include <cstdio>
#include <ctime>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/ensemble/tbb_executor.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/precision/double_double.hpp"

namespace {

using namespace cradle;
using namespace bench;

ParticlesPointer between_walls(ParticleIndex n) {
  const auto wall = [](double position) { return Wall<double>{.position = position, .temperature = 0.3}; };
  return std::make_shared<Walled<double>>(gas(n), wall(-1), wall(static_cast<double>(n)));
}

// Masses 1 and 1.0001, so that even elastic particles have to be followed.
ParticlesPointer ring(ParticleIndex n) { return gas(n, 1.0001, static_cast<double>(n)); }

template <class Run, class T, class Segments>
[[gnu::noinline, gnu::no_icf]] void by_loop(Run& run, const T& to, Segments& loop) {
  run.advance(to, loop);
}
template <class Run, class T, class Segments>
[[gnu::noinline, gnu::no_icf]] void by_steps(Run& run, const T& to, Segments& steps) {
  run.advance(to, steps);
}

template <class Chain, class Law>
bool compare(const char* name, const std::shared_ptr<const Particles<typename Chain::Scalar>>& scene, const Law& law,
             double until, int pieces) {
  using T = typename Chain::Scalar;
  using Run = Simulation<T, Law, Chain>;
  Run loop(law, Chain(scene, T(0))), steps(law, Chain(scene, T(0)));
  Segments<Law, Chain> in_loop, in_steps({}, {.steps = fastest_steps()});
  double of_loop = 0, of_steps = 0, late_loop = 0, late_steps = 0;
  for (int k = 1; k <= pieces; ++k) {
    const T to(until * k / pieces);
    of_loop += late_loop = seconds_of([&] { by_loop(loop, to, in_loop); });
    of_steps += late_steps = seconds_of([&] { by_steps(steps, to, in_steps); });
  }
  const bool same = loop.counts().collisions == steps.counts().collisions && loop.energy_lost() == steps.energy_lost();
  const auto collisions = static_cast<double>(steps.counts().collisions);
  std::printf("%-13s %10.0f collisions, million/s: loop %5.1f, steps %5.1f, ratio %.2f (late %.2f); in steps %.4f%s\n",
              name, collisions, collisions / of_loop / 1e6, collisions / of_steps / 1e6, of_loop / of_steps,
              late_loop / late_steps,
              static_cast<double>(in_steps.statistics().in_steps) /
                  static_cast<double>(std::max<std::uint64_t>(in_steps.statistics().collisions, 1)),
              same ? "" : " DIFFERENT COLLISIONS");
  std::fflush(stdout);
  return same;
}

// How many times as fast two threads are as one: pieces of the two runs alternate.
bool compare_threads(const char* name, const ParticlesPointer& scene, double until, int pieces) {
  using Chain = GapChain<double>;
  using Law = Inelastic<double>;
  const Law law(0.999, 1e-5);
  TbbExecutor two(2);  // the only one: of several, oneTBB takes the least number of threads for all
  Simulation<double, Law, Chain> alone(law, Chain(scene, 0.)), together(law, Chain(scene, 0.));
  Segments<Law, Chain> by_one({}, {.steps = fastest_steps()}), by_two(workers(two), {.steps = fastest_steps()});
  double of_one = 0, of_two = 0;
  for (int k = 1; k <= pieces; ++k) {
    const double to = until * k / pieces;
    of_one += seconds_of([&] { alone.advance(to, by_one); }, CLOCK_MONOTONIC);
    of_two += seconds_of([&] { together.advance(to, by_two); }, CLOCK_MONOTONIC);
  }
  const bool same = alone.counts().collisions == together.counts().collisions;
  const auto collisions = static_cast<double>(alone.counts().collisions);
  std::printf("%-12s %10.0f collisions, million/s: one thread %5.1f, two %5.1f, ratio %.2f%s\n", name, collisions,
              collisions / of_one / 1e6, collisions / of_two / 1e6, of_one / of_two,
              same ? "" : " DIFFERENT COLLISIONS");
  std::fflush(stdout);
  return same;
}

// Each thread copies its half of so many gaps.
void compare_copies(std::size_t gaps) {
  std::vector<Gap<double>> from(gaps), to(gaps);
  const auto copied_per_second = [&](std::size_t threads) {
    TbbExecutor executor(static_cast<unsigned>(threads));
    const Workers workers = cradle::workers(executor);
    const std::size_t times = 100'000'000 / gaps;
    const double start = seconds_now(CLOCK_MONOTONIC);
    for (std::size_t k = 0; k < times; ++k, std::swap(from, to))
      workers.run(threads, [&](std::size_t job, std::size_t) {
        const std::size_t first = gaps * job / threads, last = gaps * (job + 1) / threads;
        std::copy(from.begin() + static_cast<std::ptrdiff_t>(first), from.begin() + static_cast<std::ptrdiff_t>(last),
                  to.begin() + static_cast<std::ptrdiff_t>(first));
      });
    return static_cast<double>(times * gaps) / (seconds_now(CLOCK_MONOTONIC) - start);
  };
  copied_per_second(2);
  const double one = copied_per_second(1), two = copied_per_second(2);
  std::printf("copies of %8zu gaps, million gaps/s: one thread %5.0f, two %5.0f, ratio %.2f\n", gaps, one / 1e6,
              two / 1e6, two / one);
}

}  // namespace

int main(int argc, char** argv) {
  using Equal = GapChain<double>;
  using Wide = GapChain<double_double>;
  using Unequal = GapChain<double, IndividualMasses<double>>;
  const Inelastic<double> law(0.999, 1e-5);
  const Inelastic<double_double> wide_law(double_double(0.999), double_double(1e-5));
  const Inelastic<double> elastic(1);
  const SpeedDependent<double> of_speed(0.9, 0.1, 0.2), slightly(0.99, 0.1, 0.2);
  const std::vector<std::pair<const char*, std::function<bool(const char*)>>> cases{
      {"shock/8000", [&](const char* name) { return compare<Equal>(name, rows<double>(8000), law, 6500, 13); }},
      {"gas/300", [&](const char* name) { return compare<Equal>(name, gas(300), law, 10000, 13); }},
      {"gas/1000", [&](const char* name) { return compare<Equal>(name, gas(1000), law, 3000, 13); }},
      {"gas/8000", [&](const char* name) { return compare<Equal>(name, gas(8000), law, 1000, 13); }},
      {"gas/1e5", [&](const char* name) { return compare<Equal>(name, gas(100'000), law, 100, 2); }},
      {"gas/1e6", [&](const char* name) { return compare<Equal>(name, gas(1'000'000), law, 40, 1); }},
      {"gas/1e7", [&](const char* name) { return compare<Equal>(name, gas(10'000'000), law, 10, 1); }},
      {"masses/8000", [&](const char* name) { return compare<Unequal>(name, gas(8000, 3), law, 1000, 13); }},
      {"walls/8000", [&](const char* name) { return compare<Equal>(name, between_walls(8000), law, 1000, 13); }},
      {"ring/1000", [&](const char* name) { return compare<Unequal>(name, ring(1000), elastic, 4000, 8); }},
      {"ring/8000", [&](const char* name) { return compare<Unequal>(name, ring(8000), elastic, 1000, 8); }},
      {"ring/1e5", [&](const char* name) { return compare<Unequal>(name, ring(100'000), elastic, 100, 2); }},
      {"ring/1e6", [&](const char* name) { return compare<Unequal>(name, ring(1'000'000), elastic, 40, 1); }},
      {"ring, r(w)", [&](const char* name) { return compare<Unequal>(name, ring(8000), slightly, 400, 8); }},
      {"speed/8000", [&](const char* name) { return compare<Unequal>(name, gas(8000), of_speed, 1000, 13); }},
      {"wide shock",
       [&](const char* name) { return compare<Wide>(name, rows<double_double>(8000), wide_law, 6500, 13); }},
      {"wide gas/1000",
       [&](const char* name) { return compare<Wide>(name, gas<double_double>(1000), wide_law, 3000, 13); }},
      {"wide gas/8000",
       [&](const char* name) { return compare<Wide>(name, gas<double_double>(8000), wide_law, 1000, 13); }},
      {"wide gas/1e5",
       [&](const char* name) { return compare<Wide>(name, gas<double_double>(100'000), wide_law, 100, 2); }}};
  std::printf("vectors: %s\n", fastest_steps() != nullptr ? fastest_steps()->target : "none");
  bool same = true;
  if (argc == 2 && argv[1] == std::string("threads")) {
    same &= compare_threads("shock/8000", rows<double>(8000), 6500, 13);
    same &= compare_threads("gas/8000", gas(8000), 1000, 13);
    same &= compare_threads("gas/1e5", gas(100'000), 100, 4);
    same &= compare_threads("gas/1e6", gas(1'000'000), 40, 4);
    same &= compare_threads("gas/1e7", gas(10'000'000), 10, 2);
    for (const std::size_t gaps : {8000U, 1000000U, 10000000U}) compare_copies(gaps);
    return same ? 0 : 1;
  }
  for (const auto& [name, run] : cases)
    if (argc == 1 || std::find(argv + 1, argv + argc, std::string(name)) != argv + argc) same &= run(name);
  return same ? 0 : 1;
}
