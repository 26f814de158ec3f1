// Averages over time in bins (core/observe/averages.hpp).
#pragma once

#include <array>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/averages.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

/// Without samples.
inline TimeAverages time_averages(const Scene& scene, std::size_t samples) {
  const Averages& wanted = scene.output.averages;
  return {{wanted.range[0].value, wanted.range[1].value}, wanted.bins, samples};
}

inline std::vector<Group> average_tables(const Scene& scene) {
  const Averages& wanted = scene.output.averages;
  if (!wanted.every) return {};
  Group table{"averages",
              span_of(wanted),
              {{"x", "l", "centre of the bin", time_averages(scene, TimeAverages::batches).centres()}}};
  constexpr std::array<std::array<const char*, 3>, TimeAverages::quantities> quantities{
      {{"density", "1/l", "particles per length"},
       {"mass_density", "m/l", "mass per length"},
       {"momentum_density", "m/t", "momentum per length: the current of mass"},
       {"energy_density", "m l/t^2", "kinetic energy per length"},
       {"energy_current", "m l^2/t^3", "energy through a point per time, positive to the right"},
       {"velocity", "l/t", "mass-weighted mean velocity"},
       {"temperature", "m l^2/t^2", "of a particle, sum of m (v - velocity)^2 divided by the number of particles"},
       {"pressure", "m l/t^2", "momentum through a point that moves at the velocity, per time"},
       {"heat_current", "m l^2/t^3", "energy through such a point per time, in its frame"}}};
  for (const auto& [name, unit, text] : quantities) {
    table.columns.push_back({name, unit, text, {}});
    table.columns.push_back({std::string(name) + "_sem", unit, "standard error", {}});
  }
  return {std::move(table)};
}

class AverageMeasurement {
 public:
  static constexpr MeasurementRow row = row_of_samples<&Output::averages>("averages", average_tables);

  explicit AverageMeasurement(const Measured& of) : scene_(of.scene), averages_(time_averages(of.scene, of.samples)) {}

  void find(const RunState& now, const Stopped& stopped) { now.find(averages_, stopped); }
  void record(const RunState&, const Due&, TableSink&) { averages_.add_found(); }
  void finish(const RunState&, TableSink& put) {
    if (averages_.samples() == 0 || !(put.for_file() || averages_.complete())) return;
    Group table = std::move(average_tables(scene_).front());
    const std::vector<TimeAverages::InBin> bins = averages_.averages();
    for (std::size_t q = 0; q < TimeAverages::quantities; ++q) {
      table.columns[2 * q + 1].values = numbers_of(bins, [q](const auto& bin) { return bin.value[q]; });
      table.columns[2 * q + 2].values = numbers_of(bins, [q](const auto& bin) { return bin.error[q]; });
    }
    append(table.attributes,
           {{"samples", std::uint64_t{averages_.samples()}}, {"error_growth", averages_.error_growth()}});
    put.add(std::move(table));
  }

  static auto state(auto& self) { return fields(self.averages_); }

 private:
  const Scene& scene_;
  TimeAverages averages_;
};

}  // namespace cradle::tools
