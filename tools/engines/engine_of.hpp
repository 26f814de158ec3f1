// The engine of a run in one scalar type: what a run requires of it, for every law and chain, so that all code beside
// the event loop is compiled once per scalar type, not once per engine; it costs a virtual call per sample, none per
// collision. And which one a scene gets: the names in it become the types of the hot loop: scalar, law, chain.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/setup/initial_state.hpp"

namespace cradle::tools {

template <Real T> using Observer = std::function<void(const Collision<T>&)>;

template <Real T> class Engine {
 public:
  using Scalar = T;

  Engine& operator=(Engine&&) = delete;
  virtual ~Engine() = default;

  /// Begins again with other particles that need the same engine. False if it cannot: then make another one.
  virtual bool begin_again(const std::shared_ptr<const cradle::Particles<T>>& particles) = 0;
  /// `observer` may be empty.
  virtual Status advance(const T& until, const Observer<T>& observer) = 0;
  /// Makes the next `left` collisions, or those up to `until` if these are fewer, and subtracts them from `left`. If no
  /// collisions are made, it only advances.
  virtual Status step(std::uint64_t& left, const T& until, const Observer<T>& observer) = 0;

  virtual const Counts& counts() const = 0;
  virtual const Account<T>& account() const = 0;
  virtual T energy_lost(const T& time) const = 0;
  virtual T kinetic_energy(const T& time) const = 0;
  virtual Sample<T> sample(const T& initial_energy, const T& time) const = 0;
  virtual T last_collision_time() const = 0;
  virtual const CollapseReport<T>* collapse() const = 0;  // null if no collisions are made

  /// The left particle of a collision up to `time` that rounding may add or remove (`time` is not before the last
  /// collision). None if nothing is uncertain, or if this engine does not estimate it.
  virtual std::optional<ParticleIndex> uncertain_at(const T& time) const = 0;

  /// About how far rounding has moved the kinetic energy by this time; none if this engine does not estimate it.
  virtual std::optional<T> energy_deviation(const T& time) const = 0;

  virtual ParticleIndex collided_particles() const = 0;
  virtual std::optional<T> gap_to_wall(End end, const T& time) const = 0;
  virtual Configuration<T> configuration(const T& time) const = 0;
  virtual Configuration<T> configuration_at_last_collision() const = 0;

  /// Saves the state (core/base/state.hpp); `shape` describes its fields.
  virtual void save(StateSink& to) const = 0;
  virtual void load(StateSource& from) = 0;
  virtual std::string shape() const = 0;
};

// The type that advances a run in segments; NoSegments for runs that cannot be cut.
struct NoSegments {
  NoSegments(const Workers&, const Segmentation&) {}
};
template <class Run> struct SegmentsFor { using Type = NoSegments; };
template <Real T, class Law, class Masses>
requires(!LawWithMemory<Law, T> && !Watched<Masses>) struct SegmentsFor<Simulation<T, Law, GapChain<T, Masses>>> {
  using Type = Segments<Law, GapChain<T, Masses>>;
};
template <Real T, class Law> struct SegmentsFor<Simulation<T, Law, ClusterChain<T>>> {
  using Type = Segments<Law, ClusterChain<T>>;
};

template <Real T, class Run> class EngineOf final : public Engine<T> {
 public:
  template <class... Arguments>
  explicit EngineOf(const Workers& workers, Arguments&&... arguments)
      : run_(std::forward<Arguments>(arguments)...), segments_(workers, {.steps = fastest_steps()}) {}

  bool begin_again(const std::shared_ptr<const cradle::Particles<T>>& particles) override {
    if constexpr (has_chain) run_.begin_again(particles);
    return has_chain;
  }
  Status advance(const T& until, const Observer<T>& observer) override {
    if constexpr (!std::same_as<RunSegments, NoSegments>)
      return observer ? run_.advance(until, segments_, observer) : run_.advance(until, segments_);
    else if constexpr (has_chain)
      return observer ? run_.advance(until, observer) : run_.advance(until);
    else
      return run_.advance(until);
  }

  Status step(std::uint64_t& left, const T& until, const Observer<T>& observer) override {
    if constexpr (has_chain) {
      struct Made {};
      try {
        return run_.advance(until, [&](const Collision<T>& c) {
          if (left == 0) throw Made();  // the collision that is due is then not made
          if (observer) observer(c);
          --left;
        });
      } catch (const Made&) {
        return Status::reached;
      }
    } else {
      left = 0;
      return run_.advance(until);
    }
  }

  const Counts& counts() const override { return run_.counts(); }
  const Account<T>& account() const override { return run_.account(); }
  T energy_lost(const T& time) const override { return run_.energy_lost(time); }
  T kinetic_energy(const T& time) const override { return run_.kinetic_energy(time); }
  Sample<T> sample(const T& initial_energy, const T& time) const override {
    return cradle::sample(run_, initial_energy, time);
  }
  T last_collision_time() const override { return run_.last_collision_time(); }
  const CollapseReport<T>* collapse() const override {
    if constexpr (has_chain) return &run_.collapse();
    return nullptr;
  }

  std::optional<ParticleIndex> uncertain_at(const T& time) const override {
    if constexpr (requires { run_.chain().uncertain_at(time); })
      return run_.chain().uncertain_at(run_.chain().local_time(time));
    return {};
  }

  std::optional<T> energy_deviation(const T& time) const override {
    if constexpr (requires { run_.chain().energy_deviation(time); })
      return run_.chain().energy_deviation(run_.chain().local_time(time));
    return {};
  }

  std::optional<T> gap_to_wall(End end, const T& time) const override {
    if constexpr (requires { run_.gap_to_wall(end, time); }) return run_.gap_to_wall(end, time);
    return {};
  }
  ParticleIndex collided_particles() const override { return run_.collided_particles(); }
  Configuration<T> configuration(const T& time) const override { return run_.configuration(time); }
  Configuration<T> configuration_at_last_collision() const override { return run_.configuration_at_last_collision(); }

  void save(StateSink& to) const override { cradle::save(to, run_); }
  void load(StateSource& from) override { cradle::load(from, run_); }
  std::string shape() const override { return state_shape<Run>(); }

 private:
  using RunSegments = typename SegmentsFor<Run>::Type;
  static constexpr bool has_chain = requires(const Run& run) { run.chain(); };

  Run run_;
  RunSegments segments_;
};

// ---- of a scene

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

/// Throws Error for wet particles whose masses, loss and energies make products beyond the range of the type: the law
/// would compare zeros and infinities.
template <Real T> void require_products_in_range(const Scene& scene, const cradle::Particles<T>& particles) {
  const ScalarRow& type = scalar_row(scene.run.precision);
  if (scene.law.type != LawType::wet || !(scene.law.loss > Decimal("0")) || type.least.empty()) return;
  // Of the two lightest particles, and of all in two clusters: in any pair m_l m_r w^2 is at most 2 E (m_l + m_r).
  const T loss = number<T>(scene.law.loss), energy = particles.kinetic_energy() + loss, light = particles.least_mass(),
          all = particles.total_mass(), least = from_text<T>(type.least) * from_text<T>("1e20");
  const auto finite = [](const auto&... x) { return (is_finite(T(x * T(4))) && ...); };
  if (finite(T(all * all), T(energy * all), T(energy / light)) && least < T(light * light) && least < T(loss * light))
    return;
  throw Error(scene.place("law.loss"), "wet particles whose masses, loss and energy have products beyond the range",
              fmt::format("masses from {:g}, {:g} together, energy {:g} with \"{}\"", to_double(light), to_double(all),
                          to_double(particles.kinetic_energy()), type.name),
              "give numbers nearer to 1 (other units), or run.precision = \"mpfr\"");
}

/// Throws Error for times beyond the range of double where collisions are queued by doubles alone.
template <Real T> void require_times_in_range(const Scene& scene) {
  if (WiderRange<T> && scene.run.coordinates == Coordinates::gaps) return;
  if (std::isfinite(to_double(T(number<T>(scene.run.until) - number<T>(scene.run.start))))) return;
  throw Error(scene.place("run.until"), "a time beyond the range of double, in which collisions are queued",
              fmt::format("{} with \"{}\"", scene.run.until.text, scalar_row(scene.run.precision).name),
              "give other units, or run.precision = \"mpfr\" in gaps");
}

template <Real T>
std::unique_ptr<Engine<T>> engine_of(const Scene& scene, const std::shared_ptr<const cradle::Particles<T>>& particles,
                                     const Policy<T>& policy, const Workers& workers, bool observed) {
  const T start = number<T>(scene.run.start);
  if (!law_row(scene).needs_events && !observed)  // without an observer no collisions are needed
    return std::make_unique<EngineOf<T, StickyGas<T>>>(workers, particles, start, policy);
  const auto on = [&]<class Chain, class Law>(std::type_identity<Chain>, const Law& law) {
    return std::make_unique<EngineOf<T, Simulation<T, Law, Chain>>>(workers, law, Chain(particles, start), policy);
  };
  require_times_in_range<T>(scene);
  require_products_in_range<T>(scene, *particles);
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
