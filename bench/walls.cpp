// Walls in motion, and gravity: what a bounce on a shaken floor costs, and a collision in a column.
//
//   cmake --preset release && cmake --build --preset release --target bench_walls
//   build/release/bench/bench_walls --benchmark_repetitions=3 --benchmark_report_aggregates_only=true
//
// ball     one ball on a floor that moves like a sine: one flight for each period, and a chaotic motion; also by a loop
//          in doubles that looks for a sign change in steps of a 64th of a period, and then halves and takes Newton
//          steps, which may miss what happens within such a step. Both must count the same bounces while they can:
//          the chaotic motion is another one after some fifty.
// column   1000 beads under gravity on a floor at rest, on one that moves like a sawtooth or a sine, and 1000 between
//          walls at rest; in segments and steps on one thread, and in the plain loop.
//
// Times are processor time of the thread.

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/parallel/segments.hpp"

namespace {

using namespace bench;
using Law = cradle::Inelastic<double>;
using Chain = cradle::GapChain<double>;
using Wall = cradle::Wall<double>;

Wall shaken(Wall wall, cradle::Shape shape, double amplitude, double frequency, double phase = 0) {
  wall.motion = std::make_shared<const cradle::WallMotion<double>>(shape, amplitude, frequency, phase);
  return wall;
}

// ---- one ball, which falls with the acceleration 1

struct Ball {
  double restitution, amplitude, frequency;
  static constexpr double height = 5.7, phase = -2.5;

  std::uint64_t by_cradle(double until) const {
    const Wall floor =
        shaken({.position = 0, .restitution = restitution}, cradle::Shape::sine, amplitude, frequency, phase);
    const ParticlesPointer ball = std::make_shared<cradle::List<double>>(std::vector{height}, std::vector{0.});
    cradle::Simulation run(Law(1), Chain(std::make_shared<cradle::Walled<double>>(ball, floor, std::nullopt, -1.), 0.));
    run.advance(until);
    return run.counts().collisions;
  }

  std::uint64_t by_plain_loop(double until) const {
    double t = 0, x = height, v = 0;
    const double step = 2 * std::numbers::pi / frequency / 64;
    for (std::uint64_t bounces = 0;; ++bounces) {
      const auto gap = [&](double dt) { return x + (v - dt / 2) * dt - floor(t + dt); };
      double low = 0, high = step;
      for (; !(gap(high) < 0); high += step) low = high;
      double dt = (low + high) / 2;
      for (int k = 0; k < 60 && high - low > 1e-15 * high; ++k) {
        const double g = gap(dt), closing = floor_speed(t + dt) - (v - dt);
        (g < 0 ? high : low) = dt;
        const double newton = dt + g / closing;
        const double next = low < newton && newton < high ? newton : (low + high) / 2;
        if (next == dt) break;
        dt = next;
      }
      t += dt;
      if (t > until) return bounces;
      x = floor(t);
      v = floor_speed(t) - restitution * ((v - dt) - floor_speed(t));
    }
  }

 private:
  double floor(double t) const { return amplitude * std::sin(frequency * t + phase); }
  double floor_speed(double t) const { return amplitude * frequency * std::cos(frequency * t + phase); }
};

template <class Run> void enter_ball(const std::string& name, double until, bool checked, const Run& run) {
  enter_timed(name, [=](benchmark::State& state) {
    std::uint64_t bounces = 0;
    for (auto iteration : state) {
      std::uint64_t made = 0;
      state.SetIterationTime(seconds_of([&] { made = run(until); }));
      if (checked) check(name.substr(0, name.rfind('/')), name, until, made, 0);
      bounces += made;
    }
    using benchmark::Counter;
    state.counters["bounces"] = Counter(static_cast<double>(bounces), Counter::kAvgIterations);
    state.counters["seconds/bounce"] = Counter(static_cast<double>(bounces), Counter::kIsRate | Counter::kInvert);
  });
}

// ---- a column

void enter_column(const std::string& name, Wall floor, std::optional<Wall> ceiling, double acceleration) {
  const ParticlesPointer particles =
      std::make_shared<cradle::Walled<double>>(gas(1000), std::move(floor), std::move(ceiling), acceleration);
  for (const bool in_segments : {false, true})
    enter_timed(name + (in_segments ? "/in_steps" : "/plain"), [=](benchmark::State& state) {
      std::uint64_t collisions = 0;
      for (auto iteration : state) {
        cradle::Simulation run(Law(0.9999, 1e-5), Chain(particles, 0.));
        cradle::Segments<Law, Chain> segments({}, {.steps = cradle::fastest_steps()});
        state.SetIterationTime(seconds_of([&] { in_segments ? run.advance(4000, segments) : run.advance(4000); }));
        check(name, in_segments ? "steps" : "plain", 4000, run.counts().collisions, 0);
        collisions += run.counts().collisions;
      }
      count(state, collisions);
    });
}

void enter_all() {
  const std::pair<const char*, Ball> balls[] = {{"ball/periodic", {0.5, 1.2, 1}}, {"ball/chaotic", {0.9, 0.5, 5}}};
  for (const auto& [name, ball] : balls) {
    const bool periodic = ball.restitution == 0.5;
    const Ball& of = ball;
    enter_ball(std::string(name) + "/cradle", 1e5, periodic, [of](double until) { return of.by_cradle(until); });
    enter_ball(std::string(name) + "/plain", 1e5, periodic, [of](double until) { return of.by_plain_loop(until); });
  }
  const Wall floor{.position = -1};
  enter_column("gas_between_walls", floor, Wall{.position = 1001}, 0);
  enter_column("column", floor, std::nullopt, -0.002);
  enter_column("column/sawtooth", shaken(floor, cradle::Shape::sawtooth, 0.01, 100), std::nullopt, -0.002);
  enter_column("column/sine", shaken(floor, cradle::Shape::sine, 0.3, 1), std::nullopt, -0.002);
}

}  // namespace

int main(int argc, char** argv) { return bench::measure_all(argc, argv, enter_all); }
