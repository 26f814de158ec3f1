// All active particles at times, and where a run ends early.
#pragma once

#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

class SnapshotMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "snapshots",
      .wanted = [](const Scene&) { return true; },
      .leave_out = [](Output& output) { output.snapshots.clear(); },
      .times = [](const Output& output) -> const std::vector<Decimal>& { return output.snapshots; },
      .key = "output.snapshots",
      .averaged = false,
      .kept = true,
  };

  explicit SnapshotMeasurement(const Measured&) {}

  template <Real T> void record(const MomentIn<T>& now, const Due&, TableSink& put) {
    put.add(rows(now.configuration(), now.time));
  }
  template <Real T> void record_last(const MomentIn<T>& now, TableSink& put) {
    put.add(rows(now.after_last_collision(), now.time));
  }

  static auto state(auto& self) { return std::tie(self.written_); }

 private:
  template <Real T> Recorded<T> rows(const Configuration<T>& c, const Given<T>& time) {
    std::vector<std::uint64_t> index(c.index.begin(), c.index.end());
    Recorded<T> rows{{numbered(row.name, written_),
                      {},
                      {{"x", "l", "position", {}},
                       {"v", "l/t", "velocity", {}},
                       {"m", "m", "mass", {}},
                       {"index", "1", "number of the particle at the start, from the left", {}},
                       {"gap", "l", "distance to the next particle: resolves what x cannot", {}},
                       {"closing_speed", "l/t", "velocity minus that of the next particle", {}}}},
                     columns<T>(c.x, c.v, c.m, std::move(index), c.gap, c.closing_speed),
                     {{"time", time}}};
    if (c.x.size() < 2) return rows;
    const GapStatistics<T> gaps = gap_statistics(c);
    rows.attributes.emplace_back("gap_min", gaps.least);
    rows.attributes.emplace_back("gap_median", gaps.median);
    if (c.closure_gap) rows.attributes.emplace_back("closure_gap", *c.closure_gap);
    if (c.closure_speed) rows.attributes.emplace_back("closure_speed", *c.closure_speed);
    return rows;
  }

  std::uint64_t written_ = 0;
};

}  // namespace cradle::tools
