// All active particles at times, and where a run ends early.
#pragma once

#include "cradle/core/base/fields.hpp"
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

  explicit SnapshotMeasurement(const Measured& of) : exact_(of.exact) {}

  void record(const RunState& now, const Due&, TableSink& put) { put.add(rows(now)); }
  void record_last(const RunState& now, TableSink& put) {
    if (!put.for_statistics()) put.add(rows(*now.after_last_collision()));
  }

  static auto state(auto& self) { return fields(self.written_); }

 private:
  Recorded rows(const RunState& now) {
    const auto column = [&](RunState::Column which) {
      NumberColumn numbers(exact_);
      numbers.values = now.column(which);
      if (exact_) numbers.texts = now.column_text(which);
      return numbers;
    };
    using enum RunState::Column;
    Recorded rows{{numbered(row.name, written_),
                   {},
                   {{"x", "l", "position", {}},
                    {"v", "l/t", "velocity", {}},
                    {"m", "m", "mass", {}},
                    {"index", "1", "number of the particle at the start, from the left", {}},
                    {"gap", "l", "distance to the next particle: resolves what x cannot", {}},
                    {"closing_speed", "l/t", "velocity minus that of the next particle", {}}}},
                  columns(column(x), column(v), column(m),
                          std::vector<std::uint64_t>(now.index().begin(), now.index().end()), column(gap),
                          column(closing_speed)),
                  {{"time", now.time.meant}}};
    append(rows.attributes, now.gap_numbers());
    return rows;
  }

  bool exact_;
  std::uint64_t written_ = 0;
};

}  // namespace cradle::tools
