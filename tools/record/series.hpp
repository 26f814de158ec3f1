// The time series. Its columns are one list: a row gives a column's name, unit, meaning, the scenes that have it, and
// how to fill it from the state of the run. To add a column, add a row.
#pragma once

#include <cstdint>
#include <limits>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/record/measurement.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Whether particles end up in two heavy clusters and a cloud: those that merge on a line do, on a ring they do not.
inline bool has_clouds(const Scene& scene) { return law_row(scene).merges && !scene.initial.on_ring(); }

/// What a column holds: numbers of the run's type with all their digits, doubles, or whole numbers below 2^53.
enum class Holds { numbers, doubles, whole };

struct SeriesColumn {
  const char *name, *unit, *text;
  bool (*when)(const Scene&);
  Number (*at)(const RunState&);
  Holds holds = Holds::numbers;
};

inline const std::vector<SeriesColumn>& series_columns() {
  using At = const RunState&;
  static constexpr auto plain = [](auto x) { return Number{static_cast<double>(x), nullptr}; };
  static const Number nan{none(), nullptr};
  constexpr auto always = [](const Scene&) { return true; };
  constexpr auto gravity = [](const Scene& scene) { return scene.gravity.acts(); };
  constexpr auto clouds = [](const Scene& scene) { return has_clouds(scene); };
  constexpr auto left_wall = [](const Scene& scene) { return scene.walls.left.position.has_value(); };
  constexpr auto right_wall = [](const Scene& scene) { return scene.walls.right.position.has_value(); };
  constexpr auto left_loses = [](const Scene& scene) { return scene.walls.left.dissipates(); };
  constexpr auto right_loses = [](const Scene& scene) { return scene.walls.right.dissipates(); };
  constexpr auto core = [](const Scene& scene) { return scene.output.core; };
  static const std::vector<SeriesColumn> all{
      {"time", "t", "a sample is the state after all collisions at times <= t", always,
       [](At at) -> Number { return at.time.meant; }},
      {"energy", "m l^2/t^2", "kinetic energy of all particles of the scene", always,
       [](At at) -> Number { return at.state().energy; }},
      {"potential_energy", "m l^2/t^2", "potential energy of all particles under gravity, 0 at x = 0", gravity,
       [](At at) -> Number { return at.potential_energy(); }},
      {"energy_lost", "m l^2/t^2", "energy lost in collisions since the start, with walls too", always,
       [](At at) -> Number { return at.state().energy_lost; }},
      {"collisions", "1", "collisions since the start, those below the cut-off and merges included", always,
       [](At at) { return plain(at.state().counts.collisions); }, Holds::whole},
      {"collisions_below_cutoff", "1", "collisions closing slower than the cut-off", always,
       [](At at) { return plain(at.state().counts.below_cutoff); }, Holds::whole},
      {"merges", "1", "merges since the start", always, [](At at) { return plain(at.state().counts.merges); },
       Holds::whole},
      {"particles", "1", "particles in the active zone, between the outermost that have collided", always,
       [](At at) { return plain(at.state().particles); }, Holds::whole},
      {"front_left", "l", "position of the leftmost particle that has collided", always,
       [](At at) -> Number { return at.state().front_left.value_or(nan); }},
      {"front_right", "l", "position of the rightmost particle that has collided", always,
       [](At at) -> Number { return at.state().front_right.value_or(nan); }},
      {"cloud_mass", "m", "mass of all particles in the active zone", clouds,
       [](At at) -> Number { return at.cloud().mass; }},
      {"cloud_width", "l",
       "standard deviation of position, weighted by mass, of all in the active zone but the two heaviest clusters",
       clouds, [](At at) -> Number { return at.cloud().width; }},
      {"wall_left_collisions", "1", "collisions with the left wall since the start", left_wall,
       [](At at) { return plain(at.state().walls[0].collisions); }, Holds::whole},
      {"wall_left_energy", "m l^2/t^2", "energy that the left wall has given since the start", left_wall,
       [](At at) -> Number { return at.state().walls[0].given; }},
      {"wall_left_momentum", "m l/t", "momentum that the left wall has given since the start", left_wall,
       [](At at) -> Number { return at.state().walls[0].momentum; }},
      {"wall_left_lost", "m l^2/t^2", "energy lost in the left wall since the start; energy_lost has it too",
       left_loses, [](At at) -> Number { return at.state().walls[0].dissipated; }},
      {"wall_right_collisions", "1", "collisions with the right wall since the start", right_wall,
       [](At at) { return plain(at.state().walls[1].collisions); }, Holds::whole},
      {"wall_right_energy", "m l^2/t^2", "energy that the right wall has given since the start", right_wall,
       [](At at) -> Number { return at.state().walls[1].given; }},
      {"wall_right_momentum", "m l/t", "momentum that the right wall has given since the start", right_wall,
       [](At at) -> Number { return at.state().walls[1].momentum; }},
      {"wall_right_lost", "m l^2/t^2", "energy lost in the right wall since the start; energy_lost has it too",
       right_loses, [](At at) -> Number { return at.state().walls[1].dissipated; }},
      {"core_mass", "m", "mass within three core_width about the densest place", core,
       [](At at) { return plain(at.core().mass); }, Holds::doubles},
      {"core_width", "l", "shortest length that holds more than half of the mass that has collided", core,
       [](At at) { return plain(at.core().width); }, Holds::doubles},
      {"core_velocity_range", "l/t", "range of the core's velocities, 5 % to 95 % of its mass", core,
       [](At at) { return plain(at.core().velocity_range); }, Holds::doubles},
      {"core_gap", "l", "median gap within the core", core, [](At at) { return plain(at.core().gap); }, Holds::doubles},
      {"sticky_excess", "m l^2/t^2", "energy minus that of the sticky gas that began alike", core,
       [](At at) -> Number { return at.sticky_excess(); }},
  };
  return all;
}

inline Group heaviest_table() {
  return {"series/heaviest",
          {},
          {{"mass", "m", "of the two heaviest clusters, the left and the right one; NaN: fewer than two", {}, 2},
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
           {{"mass", "m", "of the two clusters, the left and the right one; NaN: they have stuck", {}, 2},
            {"x", "l", "their positions", {}, 2},
            {"v", "l/t", "their velocities", {}, 2},
            {"index", "1", "0 or 1, which of the two at the start", {}, 2, true}}}};
}

/// Of this scene: with the columns of clouds and of the core if it has them.
inline std::vector<Group> series_tables(const Scene& scene) {
  if (scene.initial.type == InitialType::clusters) return cluster_series_tables();
  std::vector<Group> tables{{"series", {}, {}}};
  for (const auto& column : series_columns())
    if (column.when(scene)) tables.front().columns.push_back({column.name, column.unit, column.text, {}});
  if (has_clouds(scene)) tables.push_back(heaviest_table());
  return tables;
}

/// The series of a scene and, below it, the two heaviest clusters.
class SeriesMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "series",
      .wanted = [](const Scene&) { return true; },
      .samples = series_times,
      .growing = series_tables,
      .of_particles = false,
  };

  explicit SeriesMeasurement(const Measured& of)
      : table_(std::move(series_tables(of.scene).front())), clouds_(has_clouds(of.scene)), exact_(of.exact) {
    for (const SeriesColumn& column : series_columns())
      if (column.when(of.scene)) {
        columns_.push_back(&column);
        values_.emplace_back(exact_ && column.holds == Holds::numbers);
      }
  }

  // Keeps what does not change from run to run. Rows are left only by a run that was broken off.
  void begin_again() {
    if (std::exchange(rows_, 0) == 0) return;
    for (NumberColumn& column : values_) taken(column);
    for (NumberColumn* column : {&mass_, &x_, &v_}) taken(*column);
    index_.clear();
  }
  void record(const RunState& now, const Due&, TableSink& put) { record_last(now, put); }
  void record_last(const RunState& now, TableSink&) {
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k].push_back(columns_[k]->at(now));
    ++rows_;
    if (!clouds_) return;
    const Number nan{none(), nullptr};
    for (const auto* cluster : {&now.cloud().left, &now.cloud().right}) {
      mass_.push_back(*cluster ? (*cluster)->mass : nan);
      x_.push_back(*cluster ? (*cluster)->x : nan);
      v_.push_back(*cluster ? (*cluster)->v : nan);
      index_.push_back(*cluster ? static_cast<std::uint64_t>((*cluster)->index) : no_particle);
    }
  }

  static auto state(auto&) { return fields(); }

  std::size_t rows() const { return rows_; }
  void put_rows(TableSink& put) {
    if (std::exchange(rows_, 0) == 0) return;
    if (!put.take_series(values_)) {
      Columns all;
      for (std::size_t k = 0; k < values_.size(); ++k)
        if (NumberColumn rows = taken(values_[k]); columns_[k]->holds == Holds::whole)
          all.emplace_back(Numbers(std::vector<std::uint64_t>(rows.values.begin(), rows.values.end())));
        else
          all.emplace_back(std::move(rows));
      put.add(Recorded{table_, std::move(all), {}});
    }
    if (clouds_) put.add(Recorded{heaviest_table(), columns(taken(mass_), taken(x_), taken(v_), taken(index_)), {}});
  }

 private:
  static constexpr std::uint64_t no_particle = std::numeric_limits<std::uint64_t>::max();

  Group table_;
  bool clouds_, exact_;
  std::vector<const SeriesColumn*> columns_;
  std::vector<NumberColumn> values_;
  std::size_t rows_ = 0;
  NumberColumn mass_{exact_}, x_{exact_}, v_{exact_};
  std::vector<std::uint64_t> index_;
};

}  // namespace cradle::tools
