// What the structure factor and the pair distribution have in common: measured on the places of particles, at times and
// on the average over samples.
#pragma once

#include "cradle/core/observe/batch_means.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

/// Of the ring, or between walls at rest. Throws Error if there is neither.
inline double length_of(const Scene& scene, const char* key) {
  if (const auto ends = extent(scene)) return ends->second.value - ends->first.value;
  throw Error(scene.place(key), "no length", "particles that are neither on a ring nor between walls at rest",
              "give output.structure.length, or remove this key");
}

/// `wanted`: the member of Output; `table` has bins in its first column and room for numbers in its second.
template <auto wanted, Group (*table)(const Scene&)> struct PlaceTables {
  static constexpr bool any(const Scene& scene) { return (scene.output.*wanted).any(); }
  static void leave_out(Output& output) { output.*wanted = {}; }
  static DecimalColumn samples(const Scene& scene) { return samples_of(scene.output.*wanted); }
  static const std::vector<Decimal>& times(const Output& output) { return (output.*wanted).times; }
  static std::vector<Group> averages(const Scene& scene) {
    if (!(scene.output.*wanted).every) return {};
    Group average = table(scene);
    average.name += "_average";
    average.attributes = span_of(scene.output.*wanted);
    const Column& of = average.columns.back();
    average.columns.push_back({of.name + "_sem", of.unit, "standard error", {}});
    return {std::move(average)};
  }
  static constexpr MeasurementRow row(std::string_view name, std::string_view average, const char* key) {
    return {.name = name,
            .at_end = average,
            .wanted = any,
            .leave_out = leave_out,
            .samples = samples,
            .times = times,
            .key = key,
            .table_at = table,
            .tables_at_end = averages,
            .of_many_collisions = true};
  }
};

template <class Measure, class Tables> class PlaceMeasurement {
 public:
  PlaceMeasurement(const Measured& of, Measure measure, const Group& table)
      : scene_(of.scene), measure_(std::move(measure)), table_(table),
        means_(table.columns.front().rows(), std::max<std::size_t>(of.samples, 1)) {}

  void find(const Moment& now, const Stopped& stopped) { found_ = now.measured(measure_, stopped); }
  void record(const Moment&, const Due& due, TableSink& put) {
    if (due.sample) means_.add(found_);
    if (!due.table) return;
    Group table = table_;
    table.name = numbered(table_.name, written_);
    table.columns.back().values = std::move(found_);
    table.attributes = {{"time", *due.table}};
    put.add(std::move(table));
  }
  void finish(const Moment&, TableSink& put) {
    if (means_.samples() == 0 || !(put.for_file() || means_.complete())) return;
    Group table = std::move(Tables::averages(scene_).front());
    const std::vector<BatchMean> all = means_.means();
    std::vector<double> values, errors;
    for (const BatchMean& m : all) values.push_back(m.mean), errors.push_back(m.error);
    table.columns[1].values = std::move(values);
    table.columns[2].values = std::move(errors);
    add_attributes(table, {{"samples", std::uint64_t{means_.samples()}}, {"error_growth", error_growth(all)}});
    put.add(std::move(table));
  }

  static auto state(auto& self) { return std::tie(self.written_, self.means_); }

 private:
  const Scene& scene_;
  Measure measure_;
  Group table_;
  SampledMeans means_;
  std::uint64_t written_ = 0;  // tables at times
  std::vector<double> found_;
};

}  // namespace cradle::tools
