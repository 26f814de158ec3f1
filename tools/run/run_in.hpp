// From the names of a scene to the types that the hot loop is a template of: scalar, law, chain. Compiled once per
// scalar type (see tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <limits>
#include <memory>
#include <utility>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/core/gap_chain.hpp"
#include "cradle/core/position_chain.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/tools/run/initial_state.hpp"
#include "cradle/tools/run/scene_run.hpp"

namespace cradle::tools {

template <Real T, class Law, class Chain>
RunOutcome run_on(const Scene& scene, std::shared_ptr<const cradle::Bodies<T>> bodies, Law law, Chain chain,
                  const RunOptions& options, Progress& progress) {
  Policy<T> policy;
  // Elastic bodies do not collapse, those that stick cannot.
  if (scene.run.collapse == CollapsePolicy::stop && scene.law.type == LawType::inelastic &&
      scene.law.restitution < Decimal("1"))
    policy.collapse = cradle::CollapsePolicy::stop;
  if (scene.run.stop_gap) policy.stop_gap = number<T>(*scene.run.stop_gap);
  if (options.interrupt != nullptr)
    policy.interrupt = [interrupt = options.interrupt] { return interrupt->signal() != 0; };
  policy.progress = [&progress](const T& time, const Counts& counts) {
    progress.tell(to_double(time), counts.contacts);
  };
  using Engine = Simulation<T, Law, Chain>;
  Engine engine(std::move(law), std::move(chain), policy);
  return SceneRun<T, Engine>(scene, std::move(bodies), std::move(engine), options, progress)();
}

template <class T> RunOutcome run_in(const Scene& scene, const RunOptions& options) {
  const auto bodies = initial_bodies<T>(scene);
  const T start = number<T>(scene.run.start);
  Progress progress(options.progress, scene.run.start.value, scene.run.until.value);
  if (scene.law.type == LawType::wet)
    return run_on<T>(scene, bodies, Wet<T>(number<T>(scene.law.loss)), ClusterChain<T>(bodies, start), options,
                     progress);
  if (scene.law.type == LawType::sticky && !scene.output.events && !options.trace) {
    using Gas = StickyGas<T>;  // where nobody asks for contacts none need be made
    return SceneRun<T, Gas>(scene, bodies, Gas(bodies, start), options, progress)();
  }
  if (scene.law.type == LawType::sticky || scene.run.collapse == CollapsePolicy::merge) {
    const bool sticky = scene.law.type == LawType::sticky;
    const InelasticMerging<T> law(Inelastic<T>(sticky ? T(0) : number<T>(scene.law.restitution)),
                                  sticky ? std::numeric_limits<T>::max() : number<T>(scene.run.merge_speed));
    return run_on<T>(scene, bodies, law, ClusterChain<T>(bodies, start), options, progress);
  }
  const auto bouncing = [&](auto law) {
    if (scene.run.coordinates == Coordinates::absolute)
      return run_on<T>(scene, bodies, law, PositionChain<T>(bodies, start), options, progress);
    if (bodies->identical_masses()) return run_on<T>(scene, bodies, law, GapChain<T>(bodies, start), options, progress);
    return run_on<T>(scene, bodies, law, GapChain<T, IndividualMasses<T>>(bodies, start), options, progress);
  };
  const Inelastic<T> law(number<T>(scene.law.restitution), number<T>(scene.law.cutoff));
  if (scene.run.collapse == CollapsePolicy::contact_time)
    return bouncing(ContactTime<T>(law, number<T>(scene.run.contact_time)));
  return bouncing(law);
}

}  // namespace cradle::tools
