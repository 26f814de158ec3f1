// Collisions in steps of time (core/parallel/steps) and in the event loop, both in segments on one thread. Pieces of
// the two runs alternate, so that both see the same machine. The collisions and the energy lost must be the same to the
// bit; otherwise the program prints an error and ends with status 1.
//
//   cmake --preset release && cmake --build --preset release --target bench_steps
//   build/release/bench/bench_steps [CASE...]
//
// Cases are those of bench/engine.cpp, and gases with masses 1 and 3, between walls, and with a restitution that
// depends on the speed. Times are processor time of the thread. `late` is the last thirteenth of the time: 6000 to 6500
// for the shock.

#include <cstdio>
#include <ctime>

#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"

namespace {

using namespace cradle;
using namespace bench;

ParticlesPointer between_walls(ParticleIndex n) {
  const auto wall = [](double position) { return Wall<double>{.position = position, .temperature = 0.3}; };
  return std::make_shared<Walled<double>>(gas(n), wall(-1), wall(static_cast<double>(n)));
}

template <class Chain, class Law>
bool compare(const char* name, const ParticlesPointer& scene, const Law& law, double until, int pieces) {
  using Run = Simulation<double, Law, Chain>;
  Run loop(law, Chain(scene, 0.)), steps(law, Chain(scene, 0.));
  Segments<Law, Chain> by_loop, by_steps({}, {.steps = fastest_steps()});
  double of_loop = 0, of_steps = 0, late_loop = 0, late_steps = 0;
  for (int k = 1; k <= pieces; ++k) {
    const double to = until * k / pieces, start = seconds_now();
    loop.advance(to, by_loop);
    const double between = seconds_now();
    steps.advance(to, by_steps);
    const double end = seconds_now();
    of_loop += between - start, of_steps += end - between;
    late_loop = between - start, late_steps = end - between;
  }
  const bool same =
      loop.counts().collisions == steps.counts().collisions &&
      std::bit_cast<std::uint64_t>(loop.energy_lost()) == std::bit_cast<std::uint64_t>(steps.energy_lost());
  const auto collisions = static_cast<double>(steps.counts().collisions);
  std::printf("%-12s %10.0f collisions, million/s: loop %5.1f, steps %5.1f, ratio %.2f (late %.2f); in steps %.4f%s\n",
              name, collisions, collisions / of_loop / 1e6, collisions / of_steps / 1e6, of_loop / of_steps,
              late_loop / late_steps,
              static_cast<double>(by_steps.statistics().in_steps) /
                  static_cast<double>(std::max<std::uint64_t>(by_steps.statistics().collisions, 1)),
              same ? "" : " DIFFERENT COLLISIONS");
  std::fflush(stdout);
  return same;
}

}  // namespace

int main(int argc, char** argv) {
  using Equal = GapChain<double>;
  using Unequal = GapChain<double, IndividualMasses<double>>;
  const Inelastic<double> law(0.999, 1e-5);
  const SpeedDependent<double> of_speed(0.9, 0.1, 0.2);
  const std::vector<std::pair<const char*, std::function<bool(const char*)>>> cases{
      {"shock/8000", [&](const char* name) { return compare<Equal>(name, rows<double>(8000), law, 6500, 13); }},
      {"gas/1000", [&](const char* name) { return compare<Equal>(name, gas(1000), law, 3000, 13); }},
      {"gas/8000", [&](const char* name) { return compare<Equal>(name, gas(8000), law, 1000, 13); }},
      {"gas/1e5", [&](const char* name) { return compare<Equal>(name, gas(100'000), law, 100, 2); }},
      {"gas/1e6", [&](const char* name) { return compare<Equal>(name, gas(1'000'000), law, 40, 1); }},
      {"masses/8000", [&](const char* name) { return compare<Unequal>(name, gas(8000, 3), law, 1000, 13); }},
      {"walls/8000", [&](const char* name) { return compare<Equal>(name, between_walls(8000), law, 1000, 13); }},
      {"speed/8000", [&](const char* name) { return compare<Unequal>(name, gas(8000), of_speed, 1000, 13); }}};
  std::printf("vectors: %s\n", fastest_steps() != nullptr ? fastest_steps()->target : "none");
  bool same = true;
  for (const auto& [name, run] : cases)
    if (argc == 1 || std::find(argv + 1, argv + argc, std::string(name)) != argv + argc) same &= run(name);
  return same ? 0 : 1;
}
