// Where a run puts what it records, and now and then its state: in files beside its result (run_files.hpp), or nowhere,
// for replicas and proofs, which have no file of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <tuple>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/store/checkpoint.hpp"

namespace cradle::tools {

/// How far a run is.
struct RunStatus {
  double seconds = 0;  // of computing
  double time = 0;
  std::uint64_t collisions = 0;
  /// At the last check of all particles (guards.hpp); NaN before the first, or where there is no such thing.
  double gap_min = none, closure_gap = none, closure_speed = none;

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static auto state(auto& self) {
    return std::tie(self.seconds, self.time, self.collisions, self.gap_min, self.closure_gap, self.closure_speed);
  }
};

/// What has become of a run whose state is to be kept.
enum class RunIs { in_progress, interrupted, over };

class RunStore {
 public:
  virtual ~RunStore() = default;

  /// Rows of the table of that name, after those that it has; columns as in the table.
  virtual void add(Group&& rows) = 0;

  /// To be called often with the number of collisions that the run has made: cheap.
  virtual void count(std::uint64_t collisions) = 0;
  /// Checks the clock.
  virtual void check_clock() = 0;
  /// Whether `keep` is to be called, with all rows that there are added: it has not been for some time.
  virtual bool due() const = 0;
  /// Writes down how far the run is and, if it is time, interrupted or over, its state.
  virtual void keep(const RunStatus& status, const std::function<void(StateWriter&)>& save, RunIs now) = 0;

  /// What is to be loaded before the run continues; nothing for one that begins.
  virtual StateReader* loaded_from() = 0;
};

}  // namespace cradle::tools
