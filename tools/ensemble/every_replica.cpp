// The snapshots and profiles of every replica, which an ensemble keeps if its scene requests it (output.every_replica).
// A result file has one table for each time, "replicas/snapshots/0002": the rows of all replicas, one replica after the
// other, as a run of it has them, behind a column with its number. Where a run has one row less (the gaps between n
// particles), the last one of a replica is NaN. The last snapshot of a replica that ended before the end of the scene
// has a time of its own: a table in which times differ has a second column with them.
#include <algorithm>
#include <limits>
#include <set>

#include "cradle/tools/ensemble/state.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

namespace {

constexpr const char* below = "replicas/";
constexpr const char* time_column = "time";

double time_of(const Group& table) { return attribute<double>(table.attributes, "time", table.name); }

bool is_kept(std::string_view table) {
  return std::ranges::any_of(measurement_rows(), [&](const MeasurementRow* row) {
    return row->kept && table.starts_with(std::string(row->name) + "/");
  });
}

using Rows = std::vector<std::uint64_t>;

// Rows [first, last) of a column.
Column rows_of(const Column& column, std::size_t first, std::size_t last) {
  const auto part = [&]<class Values>(const Values& values) -> Numbers {
    const auto at = [&](std::size_t row) { return values.begin() + static_cast<std::ptrdiff_t>(row); };
    return Values(at(first), at(last));
  };
  return {column.name, column.unit, column.description, std::visit(part, column.values)};
}

}  // namespace

Error damaged_ensemble(const Place& place, const std::string& found) {
  return {place, "a damaged ensemble", found, "take it from a copy, or run it again", Exit::io};
}

ReplicaTables kept_tables(ReplicaIndex replica, const Result& run) {
  ReplicaTables kept;
  for (const Group& group : run.groups) {
    if (!is_kept(group.name)) continue;
    const std::size_t rows = group.columns.front().rows();
    Group table{below + group.name, {}, {{"replica", "1", "initial.replica of the run", Rows(rows, replica)}}};
    if (const auto* time = find_attribute<double>(group.attributes, "time")) table.attributes = {{"time", *time}};
    table.columns.insert(table.columns.end(), group.columns.begin(), group.columns.end());
    for (Column& column : table.columns)
      if (auto* numbers = std::get_if<std::vector<double>>(&column.values))
        numbers->resize(rows, std::numeric_limits<double>::quiet_NaN());
    kept.push_back(std::move(table));
  }
  return kept;
}

std::vector<Group> joined_tables(const KeptReplicas& kept, const std::string& folder) {
  std::map<std::string, std::set<double>> times;
  for (const auto& [replica, tables] : kept)
    for (const Group& table : tables) times[table.name].insert(time_of(table));
  GrowingTables joined;
  for (const auto& [replica, tables] : kept)
    for (Group table : tables) {
      if (times[table.name].size() > 1) {
        std::vector<double> time(table.columns.front().rows(), time_of(table));
        table.columns.insert(table.columns.begin() + 1, {time_column, "t", "of this replica", std::move(time)});
        table.attributes.clear();
      }
      table.name.insert(0, folder);
      joined.add(std::move(table));
    }
  std::ranges::sort(joined.tables(), {}, &Group::name);
  return std::move(joined.tables());
}

KeptReplicas separated_tables(const Result& result, const std::string& folder, const std::string& file) {
  KeptReplicas kept;
  for (const Group& table : result.groups) {
    if (!table.name.starts_with(folder + below) || !is_kept(table.name.substr((folder + below).size()))) continue;
    const Rows* replica = table.columns.empty() ? nullptr : std::get_if<Rows>(&table.columns.front().values);
    const bool whole =
        replica != nullptr && std::all_of(table.columns.begin(), table.columns.end(),
                                          [&](const Column& c) { return c.width == 1 && c.rows() == replica->size(); });
    if (!whole) throw damaged_ensemble({file, 0, table.name}, "columns of different lengths");
    for (std::size_t first = 0, last = 0; first < replica->size(); first = last) {
      while (last < replica->size() && (*replica)[last] == (*replica)[first]) ++last;
      Group one{table.name.substr(folder.size()), table.attributes, {}};
      for (const Column& column : table.columns) one.columns.push_back(rows_of(column, first, last));
      if (one.columns.size() > 1 && one.columns[1].name == time_column) {
        one.attributes.emplace_back("time", std::get<std::vector<double>>(one.columns[1].values).front());
        one.columns.erase(one.columns.begin() + 1);
      }
      kept[(*replica)[first]].push_back(std::move(one));
    }
  }
  return kept;
}

}  // namespace cradle::tools
