// A run of a scene in one scalar type. Compiled once per scalar type (tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <memory>

#include "cradle/tools/engines/engine_of.hpp"
#include "cradle/tools/run/scene_run.hpp"

namespace cradle::tools {

template <Real T> Policy<T> policy_of(const Scene& scene, const RunOptions& options, Progress& progress) {
  Policy<T> policy;
  // Elastic particles collapse only against a wall that loses energy; particles that stick do not collapse.
  if (stops_at_collapse(scene) &&
      (scene.law.restitution < Decimal("1") || scene.walls.left.dissipates() || scene.walls.right.dissipates()))
    policy.collapse = cradle::CollapsePolicy::stop;
  if (scene.run.stop_gap) policy.stop_gap = number<T>(*scene.run.stop_gap);
  policy.interrupt = [interrupt = options.interrupt, store = options.store] {
    return (interrupt != nullptr && interrupt->signal() != 0) || (store != nullptr && store->due());
  };
  policy.progress = [&progress, store = options.store](const T& time, const Counts& counts) {
    progress.report(to_double(time), counts.collisions);
    if (store != nullptr) store->count(counts.collisions);
  };
  return policy;
}

template <class T> RunOutcome run_in(const Scene& scene, const RunOptions& options) {
  const auto particles = initial_particles<T>(scene);
  Progress progress(options.progress, scene.run.start.value, scene.run.until.value, options.predictable);
  const auto engine = engine_of<T>(scene, particles, policy_of<T>(scene, options, progress), options.workers,
                                   scene.output.observes_collisions() || options.observer != nullptr);
  return SceneRun<T>(scene, particles, *engine, options, progress)();
}

}  // namespace cradle::tools
