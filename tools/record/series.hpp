// The time series. Its columns are one list: a row gives a column's name, unit, meaning, the scenes that have it, and
// how to fill it from a moment of the run. To add a column, add a row.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/tools/record/measurement.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Whether particles end up in two heavy clusters and a cloud: those that merge on a line do, on a ring they do not.
inline bool has_clouds(const Scene& scene) { return law_row(scene).merges && !scene.initial.on_ring(); }

/// How a column is filled: a container for its numbers, and a function that adds one. Numbers are of the run's type,
/// given by the scene, doubles or whole numbers.
template <Real T> struct Filling {
  using Values = typename Columns<T>::value_type;
  Values (*empty)();
  void (*enter)(const MomentIn<T>&, Values&);
};
template <Real T, auto value> constexpr Filling<T> filled_by() {
  using Entry = decltype(value(std::declval<const MomentIn<T>&>()));
  using Values = typename Filling<T>::Values;
  if constexpr (std::same_as<Entry, T> || std::same_as<Entry, Given<T>>)
    return {[] { return Values(std::vector<Entry>()); },
            [](const MomentIn<T>& at, Values& to) { std::get<std::vector<Entry>>(to).push_back(value(at)); }};
  else
    return {[] { return Values(Numbers(std::vector<Entry>())); },
            [](const MomentIn<T>& at, Values& to) {
              std::get<std::vector<Entry>>(std::get<Numbers>(to)).push_back(value(at));
            }};
}

template <Real T> struct SeriesColumn {
  const char *name, *unit, *text;
  bool (*when)(const Scene&);
  Filling<T> filling;
};

template <Real T> const std::vector<SeriesColumn<T>>& series_columns() {
  using At = const MomentIn<T>&;
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
       filled_by<T, [](At at) { return at.state().energy; }>()},
      {"potential_energy", "m l^2/t^2", "potential energy of all particles under gravity, 0 at x = 0", gravity,
       filled_by<T, [](At at) { return at.potential_energy(); }>()},
      {"energy_lost", "m l^2/t^2", "energy lost in collisions since the start, with walls too", always,
       filled_by<T, [](At at) { return at.state().energy_lost; }>()},
      {"collisions", "1", "collisions since the start, those below the cut-off and merges included", always,
       filled_by<T, [](At at) { return Whole{at.state().counts.collisions}; }>()},
      {"collisions_below_cutoff", "1", "collisions closing slower than the cut-off", always,
       filled_by<T, [](At at) { return Whole{at.state().counts.below_cutoff}; }>()},
      {"merges", "1", "merges since the start", always,
       filled_by<T, [](At at) { return Whole{at.state().counts.merges}; }>()},
      {"particles", "1", "particles in the active zone, between the outermost that have collided", always,
       filled_by<T, [](At at) { return static_cast<Whole>(at.state().particles); }>()},
      {"front_left", "l", "position of the leftmost particle that has collided", always,
       filled_by<T, [](At at) { return at.state().front_left.value_or(none<T>()); }>()},
      {"front_right", "l", "position of the rightmost particle that has collided", always,
       filled_by<T, [](At at) { return at.state().front_right.value_or(none<T>()); }>()},
      {"cloud_mass", "m", "mass of all particles that have collided", clouds,
       filled_by<T, [](At at) { return at.cloud().mass; }>()},
      {"cloud_width", "l",
       "standard deviation of position, weighted by mass, of all that have collided but the two heaviest clusters",
       clouds, filled_by<T, [](At at) { return at.cloud().width; }>()},
      {"wall_left_collisions", "1", "collisions with the left wall since the start", left_wall,
       filled_by<T, [](At at) { return Whole{at.state().walls[0].collisions}; }>()},
      {"wall_left_energy", "m l^2/t^2", "energy that the left wall has given since the start", left_wall,
       filled_by<T, [](At at) { return at.state().walls[0].given.value(); }>()},
      {"wall_left_momentum", "m l/t", "momentum that the left wall has given since the start", left_wall,
       filled_by<T, [](At at) { return at.state().walls[0].momentum.value(); }>()},
      {"wall_left_lost", "m l^2/t^2", "energy lost in the left wall since the start; energy_lost has it too",
       left_loses, filled_by<T, [](At at) { return at.state().walls[0].dissipated.value(); }>()},
      {"wall_right_collisions", "1", "collisions with the right wall since the start", right_wall,
       filled_by<T, [](At at) { return Whole{at.state().walls[1].collisions}; }>()},
      {"wall_right_energy", "m l^2/t^2", "energy that the right wall has given since the start", right_wall,
       filled_by<T, [](At at) { return at.state().walls[1].given.value(); }>()},
      {"wall_right_momentum", "m l/t", "momentum that the right wall has given since the start", right_wall,
       filled_by<T, [](At at) { return at.state().walls[1].momentum.value(); }>()},
      {"wall_right_lost", "m l^2/t^2", "energy lost in the right wall since the start; energy_lost has it too",
       right_loses, filled_by<T, [](At at) { return at.state().walls[1].dissipated.value(); }>()},
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

inline Group heaviest_table() {
  return {"series/heaviest",
          {},
          {{"mass", "m", "of the two heaviest clusters, the left and the right one", {}, 2},
           {"x", "l", "their positions", {}, 2},
           {"v", "l/t", "their velocities", {}, 2},
           {"index", "1", "number at the start of the particle they go by, the same after passing", {}, 2, true}}};
}

/// The tables of the model of two clusters.
inline std::vector<Group> cluster_series_tables() {
  return {{"series",
           {},
           {{"time", "t", "a sample is the state after all meetings at times <= t", {}},
            {"energy", "m l^2/t^2", "kinetic energy of the two clusters", {}},
            {"energy_lost", "m l^2/t^2", "energy lost where they met", {}},
            {"collisions", "1", "how often they have met", {}},
            {"merges", "1", "how often they have stuck", {}}}},
          {"series/heaviest",
           {},
           {{"mass", "m", "of the two clusters, the left and the right one", {}, 2},
            {"x", "l", "their positions", {}, 2},
            {"v", "l/t", "their velocities", {}, 2},
            {"index", "1", "0 or 1, which of the two at the start", {}, 2, true}}}};
}

/// Of this scene: with the columns of clouds and of the core if it has them.
inline std::vector<Group> series_tables(const Scene& scene) {
  if (scene.initial.type == InitialType::clusters) return cluster_series_tables();
  std::vector<Group> tables{{"series", {}, {}}};
  for (const auto& column : series_columns<double>())
    if (column.when(scene)) tables.front().columns.push_back({column.name, column.unit, column.text, {}});
  if (has_clouds(scene)) tables.push_back(heaviest_table());
  return tables;
}

/// The series of a scene and, below it, the two heaviest clusters.
template <Real T> class SeriesMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "series",
      .wanted = [](const Scene&) { return true; },
      .samples = series_times,
      .growing = series_tables,
      .of_particles = false,
  };

  explicit SeriesMeasurement(const Measured& of)
      : table_(std::move(series_tables(of.scene).front())), clouds_(has_clouds(of.scene)) {
    for (const SeriesColumn<T>& column : series_columns<T>())
      if (column.when(of.scene)) fillings_.push_back(column.filling), values_.push_back(column.filling.empty());
  }

  void record(const MomentIn<T>& now, const Due&, TableSink& put) { record_last(now, put); }
  void record_last(const MomentIn<T>& now, TableSink&) {
    for (std::size_t k = 0; k < values_.size(); ++k) fillings_[k].enter(now, values_[k]);
    ++rows_;
    if (!clouds_) return;
    for (const auto* cluster : {&now.cloud().left, &now.cloud().right}) {
      mass_.push_back(*cluster ? (*cluster)->mass : none<T>());
      x_.push_back(*cluster ? (*cluster)->x : none<T>());
      v_.push_back(*cluster ? (*cluster)->v : none<T>());
      index_.push_back(*cluster ? static_cast<std::uint64_t>((*cluster)->index) : no_particle);
    }
  }

  static auto state(auto&) { return std::tie(); }

  std::size_t rows() const { return rows_; }
  void put_rows(TableSink& put) {
    if (std::exchange(rows_, 0) == 0) return;
    put.add(Recorded<T>{table_, std::move(values_), {}});
    values_.clear();
    for (const Filling<T>& filling : fillings_) values_.push_back(filling.empty());
    if (clouds_)
      put.add(Recorded<T>{heaviest_table(), columns<T>(taken(mass_), taken(x_), taken(v_), taken(index_)), {}});
  }

 private:
  static constexpr std::uint64_t no_particle = std::numeric_limits<std::uint64_t>::max();

  Group table_;
  bool clouds_;
  std::vector<Filling<T>> fillings_;
  Columns<T> values_;
  std::size_t rows_ = 0;
  std::vector<T> mass_, x_, v_;
  std::vector<std::uint64_t> index_;
};

}  // namespace cradle::tools
