// The tables that a run of a scene writes, without the numbers: names, units, what they mean. They follow from the
// scene alone, so that ensembles know what their replicas will record before one of them has run.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// Below which the numbers of types wider than double stand as decimals.
inline constexpr std::string_view exact_folder = "exact/";
/// The name of the table whose decimals a table is; of others their own.
inline std::string_view rounded_name(std::string_view name) {
  return name.starts_with(exact_folder) ? name.substr(exact_folder.size()) : name;
}

struct RunTables {
  std::vector<Group> series;         // "series" and what stands below it
  std::optional<Group> profile;      // each profile, where there are any; with the bins of a given range
  std::optional<Group> zone;         // with its bins
  std::vector<std::string> summary;  // names of RunOutcome::summary
};
/// Throws Error where the zone's reach is unknown.
RunTables run_tables(const Scene& scene);

/// Puts the numbers into the columns of a table, in their order. Throws std::logic_error where there is another number
/// of them.
Group filled(Group table, std::vector<Numbers> columns);
template <class... Values> Group filled(Group table, Values&&... values);

// ---- each of them

/// With the numbers of clouds and of the core, where a scene has them.
Group series_table(const Scene& scene);
Group heaviest_table();
Group snapshot_table(const std::string& name);
Group profile_table(const std::string& name);
Group masses_table(const std::string& name);
Group zone_table();
Group events_table();
/// The initial state of those particles that events are about.
Group initial_table();
/// Of the model of two clusters.
std::vector<Group> cluster_series_tables();

/// Particles that merge on a line make two heavy clusters and a cloud; on a ring none are like them.
bool has_clouds(const Scene& scene);

/// What is averaged over the interaction zone. Throws Error as above.
ZoneAverage zone_average(const Scene& scene);
Group zone_result(const ZoneAverage& zone, const ZoneWidth& width, const Scene& scene);

/// As numbers with names, NaN where there is none.
std::vector<std::pair<std::string, double>> scenario_numbers(const Scenario& scenario);

// ---- implementation

template <class... Values> Group filled(Group table, Values&&... values) {
  std::vector<Numbers> columns;
  (columns.push_back(Numbers(std::forward<Values>(values))), ...);
  return filled(std::move(table), std::move(columns));
}

}  // namespace cradle::tools
