// The state of a run at one time, of which everything is measured. What needs all particles is computed once, and only
// if a measurement requires it.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/dense_core.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tools/engines/engine.hpp"
#include "cradle/tools/record/recorded.hpp"

namespace cradle::tools {

/// What is the same for every scalar type.
struct Moment {
  const double rounded;  // the time
};

template <Real T> class MomentIn : public Moment {
 public:
  MomentIn(const Engine<T>& run, std::shared_ptr<const cradle::Particles<T>> particles, const T& start,
           const Given<T>& at)
      : Moment{at.rounded}, time(at), elapsed(at.value - start), run_(run), particles_(std::move(particles)),
        start_(start) {}

  const Given<T> time;
  const T elapsed;

  const Engine<T>& engine() const { return run_; }
  const cradle::Particles<T>& particles() const { return *particles_; }
  const Sample<T>& state() const {
    return computed(state_, [&] { return sample(run_, particles_->kinetic_energy(), time.value); });
  }
  const Configuration<T>& configuration() const {
    return computed(configuration_, [&] { return run_.configuration(time.value); });
  }
  /// Of a run that ends at this time, with a collision.
  Configuration<T> after_last_collision() const { return run_.configuration_at_last_collision(); }
  const Cloud<T>& cloud() const {
    return computed(cloud_, [&] { return cradle::cloud(configuration()); });
  }
  const DenseCore& core() const {
    return computed(core_, [&] { return dense_core(configuration()); });
  }
  /// Of all particles of the scene under gravity.
  T potential_energy() const { return cradle::potential_energy(configuration(), *particles_, elapsed); }
  /// Energy minus that of the sticky gas from the same initial state, from the two ledgers: what they share cancels.
  T sticky_excess() const {
    StickyGas<T> sticky(particles_,
                        start_);  // a new one: the result must not depend on earlier samples
    sticky.advance(time.value);
    const T energy = particles_->kinetic_energy();
    return T(T(energy - run_.energy_lost(time.value)) - (energy - sticky.energy_lost()));
  }

 private:
  template <class Value, class F> static const Value& computed(std::optional<Value>& value, F f) {
    if (!value) value.emplace(f());
    return *value;
  }

  const Engine<T>& run_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  T start_;
  mutable std::optional<Sample<T>> state_;
  mutable std::optional<Configuration<T>> configuration_;
  mutable std::optional<Cloud<T>> cloud_;
  mutable std::optional<DenseCore> core_;
};

}  // namespace cradle::tools
