// The structure factor and the pair distribution (core/observe/structure.hpp): measured on the places of particles, at
// times and on the average over samples.
#pragma once

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/batch_means.hpp"
#include "cradle/core/observe/structure.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

/// Of the ring, or between walls at rest. Throws Error if there is neither.
inline double length_of(const Scene& scene, const char* key) {
  if (const auto ends = extent(scene)) return ends->second.value - ends->first.value;
  throw Error(scene.place(key), "no length", "particles that are neither on a ring nor between walls at rest",
              "give output.structure.length, or remove this key");
}

/// `wanted`: the member of Output; `make` gives what measures, `table` has bins in its first column and room for
/// numbers in its second.
template <auto wanted, auto make, Group (*table)(const Scene&)> class PlaceMeasurement {
 public:
  static constexpr MeasurementRow row_of(std::string_view name, std::string_view average, const char* key) {
    MeasurementRow row = row_of_samples<wanted>(average, averages);
    row.name = name;
    row.wanted = [](const Scene& scene) { return (scene.output.*wanted).any(); };
    row.times = [](const Output& output) -> const std::vector<Decimal>& { return (output.*wanted).times; };
    row.key = key, row.table_at = table;
    return row;
  }

  explicit PlaceMeasurement(const Measured& of)
      : scene_(of.scene), measure_(make(scene_)), table_(table(scene_)),
        means_(table_.columns.front().rows(), std::max<std::size_t>(of.samples, 1)) {}

  void find(const RunState& now, const Stopped& stopped) { found_ = now.measured(measure_, stopped); }
  void record(const RunState&, const Due& due, TableSink& put) {
    if (due.sample) means_.add(found_);
    if (!due.table) return;
    Group at_time = table_;
    at_time.name = numbered(table_.name, written_);
    at_time.columns.back().values = std::move(found_);
    at_time.attributes = {{"time", *due.table}};
    put.add(std::move(at_time));
  }
  void finish(const RunState&, TableSink& put) {
    if (means_.empty() || !(put.for_file() || means_.complete())) return;
    Group average = std::move(averages(scene_).front());
    const std::vector<BatchMean> all = means_.means();
    average.columns[1].values = numbers_of(all, &BatchMean::mean);
    average.columns[2].values = numbers_of(all, &BatchMean::error);
    append(average.attributes, {{"samples", std::uint64_t{means_.samples()}}, {"error_growth", error_growth(all)}});
    put.add(std::move(average));
  }

  static auto state(auto& self) { return fields(self.written_, self.means_); }

 private:
  static std::vector<Group> averages(const Scene& scene) {
    if (!(scene.output.*wanted).every) return {};
    Group average = table(scene);
    average.name += "_average";
    average.attributes = span_of(scene.output.*wanted);
    const Column& of = average.columns.back();
    average.columns.push_back({of.name + "_sem", of.unit, "standard error", {}});
    return {std::move(average)};
  }

  const Scene& scene_;
  decltype(make(std::declval<const Scene&>())) measure_;
  Group table_;
  SampledMeans means_;
  std::uint64_t written_ = 0;  // tables at times
  std::vector<double> found_;
};

/// Throws Error if no length is known.
inline StructureFactor structure_factor(const Scene& scene) {
  const Structure& wanted = scene.output.structure;
  return {wanted.length ? wanted.length->value : length_of(scene, "output.structure"), wanted.waves};
}

inline Group structure_table(const Scene& scene) {
  return {"structure",
          {},
          {{"k", "1/l", "wave number, 2 pi n/length", structure_factor(scene).wave_numbers()},
           {"s", "1", "structure factor, |sum m exp(ikx)|^2/sum m^2; 1 at independent places", {}}}};
}

struct StructureMeasurement : PlaceMeasurement<&Output::structure, structure_factor, structure_table> {
  using PlaceMeasurement::PlaceMeasurement;
  static constexpr MeasurementRow row = row_of("structure", "structure_average", "output.structure.times");
};

/// Throws Error if no length is known.
inline PairDistribution pair_distribution(const Scene& scene) {
  const Pairs& wanted = scene.output.pair_distribution;
  return {wanted.distance.value, wanted.bins, length_of(scene, "output.pair_distribution"), scene.initial.on_ring()};
}

inline Group pair_table(const Scene& scene) {
  return {"pair_distribution",
          {},
          {{"distance", "l", "centre of the bin", pair_distribution(scene).centres()},
           {"pair_distribution", "1", "pairs at this distance, over their mean number at independent places", {}}}};
}

struct PairMeasurement : PlaceMeasurement<&Output::pair_distribution, pair_distribution, pair_table> {
  using PlaceMeasurement::PlaceMeasurement;
  static constexpr MeasurementRow row =
      row_of("pair_distribution", "pair_distribution_average", "output.pair_distribution.times");
};

}  // namespace cradle::tools
