// The tables that a run of a scene writes, without the numbers: names, units, meanings. They follow from the scene
// alone, so an ensemble knows what its replicas will record before one has run.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/observe/averages.hpp"
#include "cradle/core/observe/correlations.hpp"
#include "cradle/core/observe/histograms.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/structure.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct RunTables {
  std::vector<Group> series;      // "series" and the tables below it
  std::optional<Group> profile;   // for each profile, if the scene has any; with its bins if the range is given
  std::optional<Group> zone;      // with its bins
  std::optional<Group> averages;  // with its bins
  std::vector<Group> histograms;  // with their bins
  // With their lags, wave numbers and distances.
  std::optional<Group> correlations, structure_average, structure, pair_distribution_average, pair_distribution;
  std::vector<std::string> summary;  // names of RunOutcome::summary
};
/// Throws Error if the extent of the zone is unknown.
RunTables run_tables(const Scene& scene);

/// Puts the numbers into the columns of a table, in order. Throws std::logic_error if their number differs.
Group filled(Group table, std::vector<Numbers> columns);
template <class... Values> Group filled(Group table, Values&&... values);

// ---- single tables

/// Includes the columns of clouds and of the core if the scene has them.
Group series_table(const Scene& scene);
Group heaviest_table();
Group snapshot_table(const std::string& name);
Group profile_table(const std::string& name);
Group masses_table(const std::string& name);
Group zone_table();
Group averages_table();
Group histogram_table(std::string_view name);
Group correlations_table(const Scene& scene);
Group structure_table(const std::string& name, const Scene& scene);
Group pair_distribution_table(const std::string& name, const Scene& scene);
Group events_table();
/// The collisions as letters (output.word).
Group sequence_table();
/// The initial state of the particles that events refer to.
Group initial_table();
/// The tables of the model of two clusters.
std::vector<Group> cluster_series_tables();

/// Whether particles end up in two heavy clusters and a cloud: those that merge on a line do, on a ring they do not.
bool has_clouds(const Scene& scene);

/// The average over the interaction zone. Throws Error as above.
ZoneAverage zone_average(const Scene& scene);
Group zone_result(const ZoneAverage& zone, const ZoneWidth& width, const Scene& scene);

/// Averages over time, without samples.
TimeAverages time_averages(const Scene& scene, std::size_t samples);
Group averages_result(const TimeAverages& averages, const Scene& scene);
OctaveBins histogram_bins(std::string_view name, const Scene& scene);
Group histogram_result(std::string_view name, const OctaveHistogram& histogram, const Scene& scene);

Group correlations_result(const Correlator& correlator, std::size_t particles, const Scene& scene);

/// Throw Error if no length is known.
StructureFactor structure_factor(const Scene& scene);
PairDistribution pair_distribution(const Scene& scene);
/// Such a table from numbers at one time, or from their averages over samples.
Group at_time(Group table, double time, std::vector<double> numbers);
Group averaged(Group table, const SampledMeans& means, const PlaceTimes& wanted);

/// Named numbers; NaN for those that the run does not have.
std::vector<std::pair<std::string, double>> scenario_numbers(const Scenario& scenario);

// ---- implementation

template <class... Values> Group filled(Group table, Values&&... values) {
  std::vector<Numbers> columns;
  (columns.push_back(Numbers(std::forward<Values>(values))), ...);
  return filled(std::move(table), std::move(columns));
}

}  // namespace cradle::tools
