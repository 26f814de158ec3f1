// The number of clusters of each mass at times.
#pragma once

#include <cmath>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

class MassMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "masses",
      .wanted = [](const Scene& scene) { return !scene.output.masses.empty(); },
      .leave_out = [](Output& output) { output.masses.clear(); },
      .times = [](const Output& output) -> const std::vector<Decimal>& { return output.masses; },
      .key = "output.masses",
      .averaged = false,
  };

  explicit MassMeasurement(const Measured&) {}

  void record(const RunState& now, const Due&, TableSink& put) {
    const double least = now.least_mass();
    std::vector<std::uint64_t> clusters = now.mass_distribution();
    std::vector<double> from;
    for (std::size_t k = 0; k < clusters.size(); ++k) from.push_back(least * std::exp2(static_cast<double>(k) / 4));
    put.add(Group{numbered(row.name, written_),
                  {{"time", now.time.meant.value}},
                  {{"mass", "m", "least mass of the bin, which ends where the next one begins: 2^(1/4) times as high",
                    std::move(from)},
                   {"clusters", "1", "clusters of such a mass", std::move(clusters)}}});
  }

  static auto state(auto& self) { return fields(self.written_); }

 private:
  std::uint64_t written_ = 0;
};

}  // namespace cradle::tools
