// Where a run writes all that it records: its tables, piece by piece, and how it ended. A sink that can continue runs
// also gets their state from time to time. Files are one sink (store/run_files.hpp), memory is the other.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

/// How a run, a replica or a proof ends. One table gives the text in results and the exit status. The first five are
/// also outcomes of replicas. Files store these numbers.
enum class RunEnd : std::uint64_t {
  reached,
  collapsed,
  order_lost,
  exhausted,
  failed,
  small_gap,  // below run.stop_gap, without a proof of collapse; for replicas: collapsed
  interrupted,
  undecided,  // of a proof
  unproved    // where many particles collapse, by the default (core/engine/collapse.hpp); for replicas: collapsed
};
inline constexpr std::size_t outcome_count = 5;

struct EndRow {
  RunEnd type;
  std::string_view text;
  Exit status;
};

inline constexpr std::array<EndRow, 9> run_ends{{
    {RunEnd::reached, "reached the end", Exit::done},
    {RunEnd::collapsed, "inelastic collapse", Exit::collapse},
    {RunEnd::order_lost, "order of collisions lost", Exit::lost},
    {RunEnd::exhausted, "resolution exhausted", Exit::lost},
    {RunEnd::failed, "failed", Exit::lost},
    {RunEnd::small_gap, "a gap below run.stop_gap", Exit::collapse},
    {RunEnd::interrupted, "interrupted", Exit::interrupted},
    {RunEnd::undecided, "undecided", Exit::lost},
    {RunEnd::unproved, "inelastic collapse of many particles, not proved", Exit::collapse},
}};
static_assert(rows_in_order(run_ends));

constexpr const EndRow& end_row(RunEnd end) { return run_ends[static_cast<std::size_t>(end)]; }

/// The exit status for the text in a result; done for other texts.
constexpr Exit status_of_text(std::string_view text) {
  for (const EndRow& row : run_ends)
    if (row.text == text) return row.status;
  return Exit::done;
}

/// The progress of a run.
struct RunStatus {
  double seconds = 0;  // of computing
  double time = 0;
  std::uint64_t collisions = 0;
  /// What the last check of all particles found (guards.hpp); NaN before the first check, or if there is none.
  double gap_min = none, closure_gap = none, closure_speed = none;

  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static auto state(auto& self) {
    return fields(self.seconds, self.time, self.collisions, self.gap_min, self.closure_gap, self.closure_speed);
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
