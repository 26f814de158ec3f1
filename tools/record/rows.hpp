// What others than the run must know of a measurement: when it is due, which tables it has, and what becomes of it in
// ensembles, in a run with a later end, and where only collisions are compared.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct MeasurementRow {
  std::string_view name;         // also of the table that grows, or of the folder of the tables at times
  std::string_view at_end = {};  // the table, or the folder of tables, that is made at the end
  bool (*wanted)(const Scene&);
  void (*leave_out)(Output&) = nullptr;  // null: runs that are compared have it too

  /// The times of its samples, and those at which it writes a table. `key` names the scene's list of the latter, which
  /// a later end of the run does not extend.
  DecimalColumn (*samples)(const Scene&) = nullptr;
  const std::vector<Decimal>& (*times)(const Output&) = nullptr;
  const char* key = "";

  /// Its tables without the numbers, but with their bins: those that grow by rows during the run, that at a time, those
  /// at the end with the span of their time, and the names of its numbers of the whole run.
  std::vector<Group> (*growing)(const Scene&) = nullptr;
  Group (*table_at)(const Scene&) = nullptr;
  std::vector<Group> (*tables_at_end)(const Scene&) = nullptr;
  std::vector<std::string> (*summary)(const Scene&) = nullptr;

  bool of_particles = true;         // measured on all particles, not on the sample of the series
  bool of_many_collisions = false;  // averages, to which the order of single collisions does not matter
  bool averaged = true;             // over the replicas of an ensemble
  bool kept = false;                // of every replica, if the scene asks for that
  const char* until_end = nullptr;  // the key of one that lasts up to the end: no run with it is extended; else null
};

/// All of them, in the order of their tables.
std::span<const MeasurementRow* const> measurement_rows();

std::size_t row_number(std::string_view name);

/// A time at which a run is recorded: the decimal in the scene, or the run's own time if the scene gives none.
struct RequestedTime {
  Decimal time;
  bool of_series = false, of_snapshots = false;
  bool last = false;  // the end of the run
};

DecimalColumn series_times(const Scene& scene);

/// The tables of a result in their order: those that grow and those at times,
/// those made at the end, the collapse.
std::vector<Group> in_order(GrowingTables&& tables);

}  // namespace cradle::tools
