// Where a run writes all that it records: its tables, piece by piece, and how it ended. A sink that can continue runs
// also gets their state from time to time. Files are one sink (store/run_files.hpp), memory is the other.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/run/ends.hpp"

namespace cradle::tools {

/// The progress of a run.
struct RunStatus {
  double seconds = 0;  // of computing
  double time = 0;
  std::uint64_t collisions = 0;
  /// What the last check of all particles found (guards.hpp); NaN before the first check, or if there is none.
  double gap_min = none, closure_gap = none, closure_speed = none;

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static auto state(auto& self) {
    return std::tie(self.seconds, self.time, self.collisions, self.gap_min, self.closure_gap, self.closure_speed);
  }
};

/// The situation in which the state is to be kept.
enum class RunIs { in_progress, interrupted, over };

class Sink : public TableSink {
 public:
  using TableSink::add;
  using TableSink::TableSink;

  /// The run is over and has added all its tables. `attributes` are those of the result; for a file they begin with its
  /// provenance.
  virtual void end(std::vector<Attribute>&& attributes, RunEnd how) = 0;

  /// Called often with the number of collisions that the run has made; it is cheap.
  virtual void count(std::uint64_t collisions) {
    if (collisions < next_check_) return;
    next_check_ = collisions + collisions_between_checks;
    check_clock();
  }
  virtual void check_clock() {}
  /// Whether it is time to call `keep`, after all rows have been added.
  virtual bool due() const { return false; }
  /// Writes the progress of the run, and its state if that is due or if the run is interrupted or over.
  virtual void keep(const RunStatus&, const std::function<void(StateSink&)>& /* save */, RunIs) {}
  /// The state to load before the run continues; null for a new run.
  virtual StateSource* loaded_from() { return nullptr; }

 private:
  static constexpr std::uint64_t collisions_between_checks = 1 << 13;  // of the clock

  std::uint64_t next_check_ = 0;
};

class MemorySink : public Sink {
 public:
  explicit MemorySink(Tables tables = Tables::for_numbers) : Sink(tables) {}

  using Sink::add;
  void add(Group&& rows) override { tables_.add(std::move(rows)); }
  void end(std::vector<Attribute>&& attributes, RunEnd) override { attributes_ = std::move(attributes); }

  std::vector<Group>& tables() { return tables_.tables(); }
  /// Drops all tables.
  void clear() {
    if (!tables().empty()) tables_ = GrowingTables();
  }
  /// Of a run that is over.
  Result result() const& { return {attributes_, in_order(GrowingTables(tables_))}; }
  Result result() && { return {std::move(attributes_), in_order(std::move(tables_))}; }

 private:
  GrowingTables tables_;
  std::vector<Attribute> attributes_;
};

}  // namespace cradle::tools
