// The sample that an observer of a run receives at an output time (run_observer.hpp), as decimals of the run's scalar
// type.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cradle/core/observe/sample.hpp"
#include "cradle/tools/engines/engine.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/run/run_observer.hpp"

namespace cradle::tools {

template <Real T> SampledParticles sampled(const Configuration<T>& c) {
  const auto texts = [](const std::vector<T>& numbers) {
    std::vector<std::string> all;
    for (const T& number : numbers) all.push_back(to_text(number));
    return all;
  };
  return {c.from, c.to, c.index, texts(c.x), texts(c.v), texts(c.m)};
}

template <Real T> SampledWall sampled(const WallTally<T>& wall) {
  return {wall.collisions, to_text(wall.given.value()), to_text(wall.momentum.value()),
          to_text(wall.dissipated.value())};
}

/// `energy`: at the start; `at_collision`: the run ends at this time, with a collision.
template <Real T>
RunSample run_sample(const Scene& scene, const Schedule<T>& plan, const Engine<T>& engine, const T& energy,
                     const T& time, bool at_collision) {
  const Sample<T> now = sample(engine, energy, time);
  const Given<T> meant = at_collision ? Given<T>(time) : plan.meant(time);
  const auto text = [](const std::optional<T>& x) { return x ? to_text(*x) : std::string(); };
  RunSample at_time{.time = {meant.rounded, to_text(time)},
                    .epsilon = from_text<long double>(to_text(T(std::numeric_limits<T>::epsilon()))),
                    .requested = at_collision ? std::vector{RequestedTime{Decimal(to_text(time)), true, false, true}}
                                              : requested_times(scene, plan, time),
                    .of_series = plan.series().hold(time),
                    .at_collision = at_collision,
                    .counts = now.counts,
                    .energy = to_text(now.energy),
                    .front_left = text(now.front_left),
                    .front_right = text(now.front_right),
                    .particles = {},
                    .walls = {sampled(now.walls[0]), sampled(now.walls[1])}};
  if (!at_collision && plan.snapshots().hold(time)) at_time.particles = sampled(engine.configuration(time));
  return at_time;
}

}  // namespace cradle::tools
