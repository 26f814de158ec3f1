// Stores what a run records and, from time to time, its state: in files beside the result (run_files.hpp), or not at
// all for replicas and proofs, which have no files of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <tuple>

#include "cradle/tools/result/result.hpp"
#include "cradle/core/base/state_stream.hpp"

namespace cradle::tools {

/// The progress of a run.
struct RunStatus {
  double seconds = 0;  // of computing
  double time = 0;
  std::uint64_t collisions = 0;
  /// At the last check of all particles (guards.hpp); NaN before the first, or if there is none.
  double gap_min = none, closure_gap = none, closure_speed = none;

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static auto state(auto& self) {
    return std::tie(self.seconds, self.time, self.collisions, self.gap_min, self.closure_gap, self.closure_speed);
  }
};

/// The situation in which the state is to be kept.
enum class RunIs { in_progress, interrupted, over };

class RunStore {
 public:
  virtual ~RunStore() = default;

  /// Appends rows to the table of that name; the columns are those of the table.
  virtual void add(Group&& rows) = 0;

  /// Call it often with the number of collisions that the run has made; it is cheap.
  virtual void count(std::uint64_t collisions) = 0;
  /// Checks the clock.
  virtual void check_clock() = 0;
  /// Whether it is time to call `keep`, after all rows have been added.
  virtual bool due() const = 0;
  /// Writes the progress of the run and, if it is time, interrupted or over, its state.
  virtual void keep(const RunStatus& status, const std::function<void(StateSink&)>& save, RunIs now) = 0;

  /// The state to load before the run continues; null for a new run.
  virtual StateSource* loaded_from() = 0;
};

}  // namespace cradle::tools
