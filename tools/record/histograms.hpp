// Histograms of collisions, gaps and clusters (core/observe/histograms.hpp).
#pragma once

#include <array>
#include <limits>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/observe/histograms.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

struct HistogramRow {
  std::string_view name;
  const char *unit, *text;
  bool of_numbers = true;  // else it counts whole numbers
};
inline constexpr std::array<HistogramRow, 7> histogram_rows{
    {{"free_flight", "t", "times between two collisions of a particle"},
     {"pair_flight", "t", "times between two collisions of a pair"},
     {"closing_speed", "l/t", "closing speeds before collisions of two particles"},
     {"dissipative_closing_speed", "l/t",
      "those of collisions by the law, neither below the cut-off nor within the contact time"},
     {"collisions_per_particle", "1", "particles, by their number of collisions", false},
     {"gap", "l", "gaps between neighbours"},
     {"cluster", "1", "clusters, by their number of particles; single ones included", false}}};

inline OctaveBins histogram_bins(bool of_numbers, const Scene& scene) {
  const auto& range = scene.output.counting.range;
  return of_numbers ? OctaveBins::of_numbers(range[0].value, range[1].value) : OctaveBins::of_counts();
}

inline std::vector<Group> histogram_tables(const Scene& scene) {
  std::vector<Group> tables;
  for (const HistogramRow& row : histogram_rows) {
    if (!scene.output.has_histogram(row.name)) continue;
    std::vector<double> low = histogram_bins(row.of_numbers, scene).low(), high(low.begin() + 1, low.end());
    high.push_back(std::numeric_limits<double>::infinity());
    tables.push_back({"histograms/" + std::string(row.name),
                      span_of(scene.output.counting),
                      {{"low", row.unit, "where the bin begins", std::move(low)},
                       {"high", row.unit, "where it ends", std::move(high)},
                       {"count", "1", row.text, {}}}});
  }
  return tables;
}

class HistogramMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "histograms",
      .at_end = "histograms",
      .wanted = [](const Scene& scene) { return !scene.output.histograms.empty(); },
      .leave_out = [](Output& output) { output.histograms.clear(); },
      .samples = [](const Scene& scene) { return samples_of(scene.output.counting); },
      .tables_at_end = histogram_tables,
      .of_many_collisions = true,
  };

  explicit HistogramMeasurement(const Measured& of)
      : scene_(of.scene), engine_(of.engine), gaps_(histogram_bins(true, of.scene)),
        clusters_(histogram_bins(false, of.scene)) {
    if (scene_.output.observes_collisions())
      engine_.count_collisions(scene_.output.counting, histogram_bins(true, scene_),
                               wanted("free_flight") || wanted("pair_flight") || wanted("collisions_per_particle"));
  }

  void record(const RunState& now, const Due&, TableSink&) {
    for (const double gap : now.column(RunState::Column::gap)) gaps_.add(gap);
    if (wanted("cluster"))
      now.for_each_cluster(*scene_.output.counting.cluster_gap,
                           [&](std::size_t particles) { clusters_.add(static_cast<double>(particles)); });
  }
  void finish(const RunState& now, TableSink& put) {
    if (!put.for_file() && now.time.exact < rounding(scene_)(scene_.output.counting.until.text)) return;
    std::vector<Group> tables = histogram_tables(scene_);
    auto table = tables.begin();
    auto counts = engine_.counted_collisions();
    for (std::size_t k = 0; k < histogram_rows.size(); ++k) {
      if (!wanted(histogram_rows[k].name)) continue;
      table->columns.back().values = k < counts.size()    ? std::move(counts[k])
                                     : k == counts.size() ? gaps_.counts()
                                                          : clusters_.counts();
      put.add(std::move(*table++));
    }
  }

  static auto state(auto& self) { return fields(self.gaps_, self.clusters_); }

 private:
  bool wanted(std::string_view name) const { return scene_.output.has_histogram(name); }

  const Scene& scene_;
  AnyEngine& engine_;
  OctaveHistogram gaps_, clusters_;
};

}  // namespace cradle::tools
