// The columns of the time series: one list. A row gives a column's name, unit, meaning, the scenes that have it, and
// how to fill it from a sample. To add a column, add a row.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/dense_core.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/tables.hpp"
#include "cradle/tools/engines/engine.hpp"

namespace cradle::tools {

/// The source of all columns at one time. Quantities that need all particles are computed once, and only if a column
/// requires them.
template <Real T> class Moment {
 public:
  Moment(const Engine<T>& run, std::shared_ptr<const cradle::Particles<T>> particles, const T& start,
         const Given<T>& at)
      : time(at), state(sample(run, particles->kinetic_energy(), at.value)), run_(run),
        particles_(std::move(particles)), start_(start) {}

  const Given<T> time;
  const Sample<T> state;

  const Configuration<T>& configuration() const {
    return computed(configuration_, [&] { return run_.configuration(state.time); });
  }
  const Cloud<T>& cloud() const {
    return computed(cloud_, [&] { return cradle::cloud(configuration()); });
  }
  const DenseCore& core() const {
    return computed(core_, [&] { return dense_core(configuration()); });
  }
  /// Of all particles of the scene under gravity.
  T potential_energy() const { return cradle::potential_energy(configuration(), *particles_, T(state.time - start_)); }
  /// Energy minus that of the sticky gas from the same initial state, from the two ledgers: what they share cancels.
  T sticky_excess() const {
    StickyGas<T> sticky(particles_, start_);  // a new one: the result must not depend on earlier samples
    sticky.advance(state.time);
    const T energy = particles_->kinetic_energy();
    return T(T(energy - run_.energy_lost(state.time)) - (energy - sticky.energy_lost()));
  }

 private:
  template <class Value, class F> static const Value& computed(std::optional<Value>& value, F f) {
    if (!value) value.emplace(f());
    return *value;
  }

  const Engine<T>& run_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  T start_;
  mutable std::optional<Configuration<T>> configuration_;
  mutable std::optional<Cloud<T>> cloud_;
  mutable std::optional<DenseCore> core_;
};

/// How a column is filled: a container for its numbers, and a function that adds one. Numbers are of the run's type,
/// given by the scene, doubles or whole numbers.
template <Real T> struct Filling {
  using Values = typename Columns<T>::value_type;
  Values (*empty)();
  void (*enter)(const Moment<T>&, Values&);
};
template <Real T, auto value> constexpr Filling<T> filled_by() {
  using Number = decltype(value(std::declval<const Moment<T>&>()));
  using Values = typename Filling<T>::Values;
  if constexpr (std::same_as<Number, T> || std::same_as<Number, Given<T>>)
    return {[] { return Values(std::vector<Number>()); },
            [](const Moment<T>& at, Values& to) { std::get<std::vector<Number>>(to).push_back(value(at)); }};
  else
    return {[] { return Values(Numbers(std::vector<Number>())); },
            [](const Moment<T>& at, Values& to) {
              std::get<std::vector<Number>>(std::get<Numbers>(to)).push_back(value(at));
            }};
}

template <Real T> struct SeriesColumn {
  const char *name, *unit, *text;
  bool (*when)(const Scene&);
  Filling<T> filling;
};

template <Real T> const std::vector<SeriesColumn<T>>& series_columns() {
  using At = const Moment<T>&;
  using Whole = std::uint64_t;
  constexpr auto always = [](const Scene&) { return true; };
  constexpr auto gravity = [](const Scene& scene) { return scene.gravity.acts(); };
  constexpr auto clouds = [](const Scene& scene) { return has_clouds(scene); };
  constexpr auto left_wall = [](const Scene& scene) { return scene.walls.left.position.has_value(); };
  constexpr auto right_wall = [](const Scene& scene) { return scene.walls.right.position.has_value(); };
  constexpr auto left_loses = [](const Scene& scene) { return scene.walls.left.dissipates(); };
  constexpr auto right_loses = [](const Scene& scene) { return scene.walls.right.dissipates(); };
  constexpr auto core = [](const Scene& scene) { return scene.output.core; };
  static const std::vector<SeriesColumn<T>> all{
      {"time", "t", "a sample is the state after all collisions at times <= t", always,
       filled_by<T, [](At at) { return at.time; }>()},
      {"energy", "m l^2/t^2", "kinetic energy of all particles of the scene", always,
       filled_by<T, [](At at) { return at.state.energy; }>()},
      {"potential_energy", "m l^2/t^2", "potential energy of all particles under gravity, 0 at x = 0", gravity,
       filled_by<T, [](At at) { return at.potential_energy(); }>()},
      {"energy_lost", "m l^2/t^2", "energy lost in collisions since the start, with walls too", always,
       filled_by<T, [](At at) { return at.state.energy_lost; }>()},
      {"collisions", "1", "collisions since the start, those below the cut-off and merges included", always,
       filled_by<T, [](At at) { return Whole{at.state.counts.collisions}; }>()},
      {"collisions_below_cutoff", "1", "collisions closing slower than the cut-off", always,
       filled_by<T, [](At at) { return Whole{at.state.counts.below_cutoff}; }>()},
      {"merges", "1", "merges since the start", always,
       filled_by<T, [](At at) { return Whole{at.state.counts.merges}; }>()},
      {"particles", "1", "particles in the active zone, between the outermost that have collided", always,
       filled_by<T, [](At at) { return static_cast<Whole>(at.state.particles); }>()},
      {"front_left", "l", "position of the leftmost particle that has collided", always,
       filled_by<T, [](At at) { return at.state.front_left.value_or(none<T>()); }>()},
      {"front_right", "l", "position of the rightmost particle that has collided", always,
       filled_by<T, [](At at) { return at.state.front_right.value_or(none<T>()); }>()},
      {"cloud_mass", "m", "mass of all particles that have collided", clouds,
       filled_by<T, [](At at) { return at.cloud().mass; }>()},
      {"cloud_width", "l",
       "standard deviation of position, weighted by mass, of all that have collided but the two heaviest clusters",
       clouds, filled_by<T, [](At at) { return at.cloud().width; }>()},
      {"wall_left_collisions", "1", "collisions with the left wall since the start", left_wall,
       filled_by<T, [](At at) { return Whole{at.state.walls[0].collisions}; }>()},
      {"wall_left_energy", "m l^2/t^2", "energy that the left wall has given since the start", left_wall,
       filled_by<T, [](At at) { return at.state.walls[0].given.value(); }>()},
      {"wall_left_momentum", "m l/t", "momentum that the left wall has given since the start", left_wall,
       filled_by<T, [](At at) { return at.state.walls[0].momentum.value(); }>()},
      {"wall_left_lost", "m l^2/t^2", "energy lost in the left wall since the start; energy_lost has it too",
       left_loses, filled_by<T, [](At at) { return at.state.walls[0].dissipated.value(); }>()},
      {"wall_right_collisions", "1", "collisions with the right wall since the start", right_wall,
       filled_by<T, [](At at) { return Whole{at.state.walls[1].collisions}; }>()},
      {"wall_right_energy", "m l^2/t^2", "energy that the right wall has given since the start", right_wall,
       filled_by<T, [](At at) { return at.state.walls[1].given.value(); }>()},
      {"wall_right_momentum", "m l/t", "momentum that the right wall has given since the start", right_wall,
       filled_by<T, [](At at) { return at.state.walls[1].momentum.value(); }>()},
      {"wall_right_lost", "m l^2/t^2", "energy lost in the right wall since the start; energy_lost has it too",
       right_loses, filled_by<T, [](At at) { return at.state.walls[1].dissipated.value(); }>()},
      {"core_mass", "m", "mass within three core_width about the densest place", core,
       filled_by<T, [](At at) { return at.core().mass; }>()},
      {"core_width", "l", "shortest length that holds more than half of the mass that has collided", core,
       filled_by<T, [](At at) { return at.core().width; }>()},
      {"core_velocity_range", "l/t", "range of the core's velocities, 5 % to 95 % of its mass", core,
       filled_by<T, [](At at) { return at.core().velocity_range; }>()},
      {"core_gap", "l", "median gap within the core", core, filled_by<T, [](At at) { return at.core().gap; }>()},
      {"sticky_excess", "m l^2/t^2", "energy minus that of the sticky gas that began alike", core,
       filled_by<T, [](At at) { return at.sticky_excess(); }>()},
  };
  return all;
}

/// The time series of a scene.
template <Real T> class SeriesRecorder {
 public:
  explicit SeriesRecorder(const Scene& scene) : table_(series_table(scene)) {
    for (const SeriesColumn<T>& column : series_columns<T>())
      if (column.when(scene)) fillings_.push_back(column.filling), values_.push_back(column.filling.empty());
  }

  void add(const Moment<T>& at) {
    for (std::size_t k = 0; k < values_.size(); ++k) fillings_[k].enter(at, values_[k]);
    ++rows_;
  }

  std::size_t rows() const { return rows_; }
  /// The rows since the last call.
  Recorded<T> take() {
    Recorded<T> rows{table_, std::move(values_), {}};
    values_.clear();
    for (const Filling<T>& filling : fillings_) values_.push_back(filling.empty());
    rows_ = 0;
    return rows;
  }

 private:
  Group table_;
  std::vector<Filling<T>> fillings_;
  Columns<T> values_;
  std::size_t rows_ = 0;
};

}  // namespace cradle::tools
