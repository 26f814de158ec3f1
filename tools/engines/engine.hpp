// What a run requires of its engine, for every law and chain: so all code beside the event loop is compiled once per
// scalar type, not once per engine. It costs a virtual call per sample, none per collision.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cradle/core/base/state.hpp"
#include "cradle/core/base/state_stream.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/parallel/segments.hpp"
#include "cradle/core/parallel/steps/steps.hpp"

namespace cradle::tools {

template <Real T> using Observer = std::function<void(const Collision<T>&)>;

template <Real T> class Engine {
 public:
  using Scalar = T;

  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
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

}  // namespace cradle::tools
