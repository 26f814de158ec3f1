// Turns the names in a scene into the types of the hot loop: scalar, law, chain.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <type_traits>

#include <fmt/format.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/tools/engines/engine.hpp"
#include "cradle/tools/engines/precision.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/initial_state.hpp"

namespace cradle::tools {

/// When a run of the scene stops by itself. `by_function`: the restitution is a function, and not that of the scene.
template <Real T> Policy<T> policy_of(const Scene& scene, bool by_function) {
  Policy<T> policy;
  // Elastic particles collapse only against a wall that loses energy; particles that stick do not collapse.
  const bool dissipates = by_function || scene.law.restitution < Decimal("1");
  if (stops_at_collapse(scene) && (dissipates || scene.walls.left.dissipates() || scene.walls.right.dissipates()))
    policy.collapse = cradle::CollapsePolicy::stop;
  if (scene.run.stop_gap) policy.stop_gap = number<T>(*scene.run.stop_gap);
  return policy;
}

// MergingLaw: particles merge or pass through each other. BouncingLaw: they bounce.
template <Real T> using MergingLaw = OneOf<Wet<T>, InelasticMerging<T>>;
template <Real T> using BouncingLaw = OneOf<Inelastic<T>, SpeedDependent<T>, ContactTime<T>>;

template <Real T> MergingLaw<T> merging_law(const Scene& scene) {
  if (scene.law.type == LawType::wet) return Wet<T>(number<T>(scene.law.loss));
  if (scene.law.type == LawType::sticky) return InelasticMerging<T>(Inelastic<T>(T(0)), std::numeric_limits<T>::max());
  return InelasticMerging<T>(Inelastic<T>(number<T>(scene.law.restitution)), number<T>(scene.run.merge_speed));
}

template <Real T> BouncingLaw<T> bouncing_law(const Scene& scene) {
  const T restitution = number<T>(scene.law.restitution), cutoff = number<T>(scene.law.cutoff);
  if (scene.law.cutoff_exponent) return SpeedDependent<T>(restitution, cutoff, number<T>(*scene.law.cutoff_exponent));
  const Inelastic<T> law(restitution, cutoff);
  if (scene.run.collapse != scene::CollapsePolicy::contact_time) return law;
  return ContactTime<T>(law, number<T>(scene.run.contact_time));
}

/// Throws Error for masses that gaps under gravity or at shaken walls cannot hold: closing speeds alone lose the digits
/// of heavy particles' velocities, and sums are not exact there.
template <Real T> void require_masses_that_fall(const Scene& scene, const cradle::Particles<T>& particles) {
  if (!(scene.gravity.acts() || scene.walls.shaken()) || !far_apart(particles) || !sums_can_be_exact<T>) return;
  throw Error(scene.place(scene.gravity.acts() ? "gravity.acceleration" : "walls"),
              "masses too far apart for gaps under gravity or between shaken walls",
              fmt::format("{:g} to {:g}, more than a factor of 10000", to_double(particles.least_mass()),
                          to_double(particles.greatest_mass())),
              "give run.coordinates = \"absolute\" or run.precision = \"double-double\"");
}

/// Throws Error for a run so short, at times so large, that it ends at its start.
template <Real T> void require_resolved(const Scene& scene) {
  const T start = number<T>(scene.run.start), until = number<T>(scene.run.until);
  if (!(scene.run.start < scene.run.until) || start < until) return;
  throw Error(scene.place("run.until"), "too close to run.start for this precision",
              fmt::format("{} after {}, which are the same in {}", scene.run.until.text, scene.run.start.text,
                          precision_name(scene.run)),
              "count times from 0 (run.start = 0), or give more digits (run.precision)");
}

template <Real T>
std::unique_ptr<Engine<T>> engine_of(const Scene& scene, const std::shared_ptr<const cradle::Particles<T>>& particles,
                                     const Policy<T>& policy, const Workers& workers, bool observed) {
  require_resolved<T>(scene);
  const T start = number<T>(scene.run.start);
  if (!law_row(scene).needs_events && !observed)  // without an observer no collisions are needed
    return std::make_unique<EngineOf<T, StickyGas<T>>>(workers, particles, start, policy);
  const auto on = [&]<class Chain, class Law>(std::type_identity<Chain>, const Law& law) {
    return std::make_unique<EngineOf<T, Simulation<T, Law, Chain>>>(workers, law, Chain(particles, start), policy);
  };
  if (particles_merge(scene)) return on(std::type_identity<ClusterChain<T>>{}, merging_law<T>(scene));
  const BouncingLaw<T> law = bouncing_law<T>(scene);
  if (scene.run.coordinates == Coordinates::absolute) return on(std::type_identity<PositionChain<T>>{}, law);
  require_masses_that_fall<T>(scene, *particles);
  if (to_be_watched(*particles, scene.initial.type == InitialType::list))
    return on(std::type_identity<GapChain<T, WatchedMasses<T>>>{}, law);
  // Only the most used law has engines of its own, one for identical masses and one for others; the bits are the same.
  const auto individual = std::type_identity<GapChain<T, IndividualMasses<T>>>{};
  const auto* inelastic = law.template as<Inelastic<T>>();
  if (inelastic != nullptr && particles->identical_masses()) return on(std::type_identity<GapChain<T>>{}, *inelastic);
  if constexpr (std::same_as<T, double>)  // in larger numbers the choice at every collision costs at most 0.1 %
    if (inelastic != nullptr) return on(individual, *inelastic);
  return on(individual, law);
}

/// The engine for a restitution that is a function of the closing speed; it has no segments, since the function may be
/// called from one thread only. Throws Error for scenes of other laws or chains.
std::unique_ptr<Engine<double>> engine_with(const std::function<double(double)>& restitution, const Scene& scene,
                                            const std::shared_ptr<const cradle::Particles<double>>& particles,
                                            const Policy<double>& policy);

}  // namespace cradle::tools
