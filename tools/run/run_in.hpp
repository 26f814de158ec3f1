// From the names of a scene to the types that the hot loop is a template of: scalar, law, chain. Compiled once per
// scalar type (see tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tools/model/initial_state.hpp"
#include "cradle/tools/model/laws.hpp"
#include "cradle/tools/run/engine.hpp"
#include "cradle/tools/run/scene_run.hpp"

namespace cradle::tools {

template <Real T> Policy<T> policy_of(const Scene& scene, const RunOptions& options, Progress& progress) {
  Policy<T> policy;
  // Elastic particles do not collapse, unless against a wall that is not; those that stick cannot.
  const auto loses = [](const WallAt& wall) {
    return wall.position && !wall.temperature && wall.restitution < Decimal("1");
  };
  if (stops_at_collapse(scene) &&
      (scene.law.restitution < Decimal("1") || loses(scene.walls.left) || loses(scene.walls.right)))
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

template <Real T>
std::unique_ptr<Engine<T>> engine_of(const Scene& scene, const std::shared_ptr<const cradle::Particles<T>>& particles,
                                     const Policy<T>& policy, const Workers& workers, bool observed) {
  const T start = number<T>(scene.run.start);
  const auto simulation = [&]<class Law, class Chain>(const Law& law, std::type_identity<Chain>) {
    return std::make_unique<EngineOf<T, Simulation<T, Law, Chain>>>(workers, law, Chain(particles, start), policy);
  };
  const std::type_identity<ClusterChain<T>> clusters;
  if (scene.law.type == LawType::wet) return simulation(Wet<T>(number<T>(scene.law.loss)), clusters);
  if (!law_row(scene).needs_events && !observed)  // without an observer no collisions need be made
    return std::make_unique<EngineOf<T, StickyGas<T>>>(workers, particles, start, policy);
  if (scene.law.type == LawType::sticky || scene.run.collapse == scene::CollapsePolicy::merge) {
    const bool sticky = scene.law.type == LawType::sticky;
    const InelasticMerging<T> law(Inelastic<T>(sticky ? T(0) : number<T>(scene.law.restitution)),
                                  sticky ? std::numeric_limits<T>::max() : number<T>(scene.run.merge_speed));
    return simulation(law, clusters);
  }
  // Few runs remember collisions or have a restitution that depends on the speed: these do without a loop of their own
  // for identical masses, whose bits are the same.
  const auto bouncing = [&](const auto& any) -> std::unique_ptr<Engine<T>> {
    if (scene.run.coordinates == Coordinates::absolute) return simulation(any, std::type_identity<PositionChain<T>>{});
    if (to_be_watched(*particles)) return simulation(any, std::type_identity<GapChain<T, WatchedMasses<T>>>{});
    return simulation(any, std::type_identity<GapChain<T, IndividualMasses<T>>>{});
  };
  if (scene.law.cutoff_exponent)
    return bouncing(SpeedDependent<T>(number<T>(scene.law.restitution), number<T>(scene.law.cutoff),
                                      number<T>(*scene.law.cutoff_exponent)));
  const Inelastic<T> law(number<T>(scene.law.restitution), number<T>(scene.law.cutoff));
  const bool remembers = scene.run.collapse == scene::CollapsePolicy::contact_time;
  if (!remembers && scene.run.coordinates == Coordinates::gaps && particles->identical_masses())
    return simulation(law, std::type_identity<GapChain<T>>{});
  if (remembers) return bouncing(ContactTime<T>(law, number<T>(scene.run.contact_time)));
  return bouncing(law);
}

template <class T> RunOutcome run_in(const Scene& scene, const RunOptions& options) {
  const auto particles = initial_particles<T>(scene);
  Progress progress(options.progress, scene.run.start.value, scene.run.until.value);
  const auto engine = engine_of<T>(scene, particles, policy_of<T>(scene, options, progress), options.workers,
                                   scene.output.events || options.observer != nullptr);
  return SceneRun<T>(scene, particles, *engine, options, progress)();
}

}  // namespace cradle::tools
