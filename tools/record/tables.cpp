#include "cradle/tools/record/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/scene/laws.hpp"
#include "cradle/tools/record/columns.hpp"

namespace cradle::tools {

namespace {

struct HistogramRow {
  std::string_view name;
  const char *unit, *text;
  bool of_numbers = true;  // else it counts whole numbers
};
constexpr std::array<HistogramRow, 7> histograms{
    {{"free_flight", "t", "times between two collisions of a particle"},
     {"pair_flight", "t", "times between two collisions of a pair"},
     {"closing_speed", "l/t", "closing speeds before collisions of two particles"},
     {"dissipative_closing_speed", "l/t",
      "those of collisions by the law, neither below the cut-off nor within the contact time"},
     {"collisions_per_particle", "1", "particles, by their number of collisions", false},
     {"gap", "l", "gaps between neighbours"},
     {"cluster", "1", "clusters, by their number of particles; single ones included", false}}};

const HistogramRow& histogram_row(std::string_view name) {
  return *std::find_if(histograms.begin(), histograms.end(), [&](const auto& row) { return row.name == name; });
}

}  // namespace

Group series_table(const Scene& scene) {
  Group table{"series", {}, {}};
  for (const auto& column : series_columns<double>())
    if (column.when(scene)) table.columns.push_back({column.name, column.unit, column.text, {}});
  return table;
}

Group heaviest_table() {
  return {"series/heaviest",
          {},
          {{"mass", "m", "of the two heaviest clusters, the left and the right one", {}, 2},
           {"x", "l", "their positions", {}, 2},
           {"v", "l/t", "their velocities", {}, 2},
           {"index", "1", "number at the start of the particle they go by, the same after passing", {}, 2, true}}};
}

std::vector<Group> cluster_series_tables() {
  return {{"series",
           {},
           {{"time", "t", "a sample is the state after all meetings at times <= t", {}},
            {"energy", "m l^2/t^2", "kinetic energy of the two clusters", {}},
            {"energy_lost", "m l^2/t^2", "energy lost where they met", {}},
            {"collisions", "1", "how often they have met", {}},
            {"merges", "1", "how often they have stuck", {}}}},
          {"series/heaviest",
           {},
           {{"mass", "m", "of the two clusters, the left and the right one", {}, 2},
            {"x", "l", "their positions", {}, 2},
            {"v", "l/t", "their velocities", {}, 2},
            {"index", "1", "0 or 1, which of the two at the start", {}, 2, true}}}};
}

Group snapshot_table(const std::string& name) {
  return {name,
          {},
          {{"x", "l", "position", {}},
           {"v", "l/t", "velocity", {}},
           {"m", "m", "mass", {}},
           {"index", "1", "number of the particle at the start, from the left", {}},
           {"gap", "l", "distance to the next particle: resolves what x cannot", {}},
           {"closing_speed", "l/t", "velocity minus that of the next particle", {}}}};
}

Group profile_table(const std::string& name) {
  return {name,
          {},
          {{"x", "l", "centre of the bin", {}},
           {"velocity", "l/t", "mass-weighted mean velocity", {}},
           {"density", "1/l", "particles per length", {}},
           {"mass_density", "m/l", "mass per length", {}},
           {"temperature", "l^2/t^2", "mass-weighted variance of velocity", {}},
           {"density_right", "1/l", "right-moving particles per length", {}},
           {"velocity_right", "l/t", "mean velocity of right-movers", {}},
           {"density_left", "1/l", "left-moving particles per length", {}},
           {"velocity_left", "l/t", "mean velocity of left-movers", {}}}};
}

Group masses_table(const std::string& name) {
  return {name,
          {},
          {{"mass", "m", "least mass of the bin, which ends where the next one begins: 2^(1/4) times as high", {}},
           {"clusters", "1", "clusters of such a mass", {}}}};
}

Group zone_table() {
  return {"zone",
          {},
          {{"x", "l", "centre of the bin", {}},
           {"mass_density", "m/l", "mass per length", {}},
           {"density_right", "1/l", "right-moving single particles per length", {}},
           {"velocity_right", "l/t", "their mean velocity", {}},
           {"density_left", "1/l", "left-moving single particles per length", {}},
           {"velocity_left", "l/t", "their mean velocity", {}}}};
}

Group averages_table() {
  Group table{"averages", {}, {{"x", "l", "centre of the bin", {}}}};
  constexpr std::array<std::array<const char*, 3>, TimeAverages::quantities> quantities{
      {{"density", "1/l", "particles per length"},
       {"mass_density", "m/l", "mass per length"},
       {"momentum_density", "m/t", "momentum per length: the current of mass"},
       {"energy_density", "m l/t^2", "kinetic energy per length"},
       {"energy_current", "m l^2/t^3", "energy through a point per time, positive to the right"},
       {"velocity", "l/t", "mass-weighted mean velocity"},
       {"temperature", "m l^2/t^2", "of a particle, sum of m (v - velocity)^2 divided by the number of particles"},
       {"pressure", "m l/t^2", "momentum through a point that moves at the velocity, per time"},
       {"heat_current", "m l^2/t^3", "energy through such a point per time, in its frame"}}};
  for (const auto& [name, unit, text] : quantities) {
    table.columns.push_back({name, unit, text, {}});
    table.columns.push_back({std::string(name) + "_sem", unit, "standard error", {}});
  }
  return table;
}

Group histogram_table(std::string_view name) {
  const HistogramRow& row = histogram_row(name);
  return {"histograms/" + std::string(name),
          {},
          {{"low", row.unit, "where the bin begins", {}},
           {"high", row.unit, "where it ends", {}},
           {"count", "1", row.text, {}}}};
}

Group correlations_table(const Scene& scene) {
  std::vector<double> lags;
  for (const std::uint64_t steps : Correlator::lags(longest_lag(scene)))
    lags.push_back(decimal_between(Decimal(), *scene.output.correlations.every, Decimal(std::to_string(steps))).value);
  return {"correlations",
          {},
          {{"lag", "t", "time between the two states", std::move(lags)},
           {"msd", "l^2", "mean-square displacement of a tagged particle, not folded on rings", {}},
           {"msd_sem", "l^2", "standard error", {}},
           {"vacf", "l^2/t^2", "velocity autocorrelation: mean product of the two velocities of a tagged particle", {}},
           {"vacf_sem", "l^2/t^2", "standard error", {}}}};
}

Group structure_table(const std::string& name, const Scene& scene) {
  return {name,
          {},
          {{"k", "1/l", "wave number, 2 pi n/length", structure_factor(scene).wave_numbers()},
           {"s", "1", "structure factor, |sum m exp(ikx)|^2/sum m^2; 1 at independent places", {}}}};
}

Group pair_distribution_table(const std::string& name, const Scene& scene) {
  return {name,
          {},
          {{"distance", "l", "centre of the bin", pair_distribution(scene).centres()},
           {"pair_distribution", "1", "pairs at this distance, over their mean number at independent places", {}}}};
}

Group events_table() {
  return {"events",
          {},
          {{"left", "1", "number of the left particle at the start", {}},
           {"right", "1", "number of the right particle at the start", {}},
           {"time", "t", "time of the collision, rounded", {}},
           {"time_low", "t", "what time misses: the collision is at time + time_low", {}},
           {"interval", "t", "time since the collision before", {}},
           {"closing_speed", "l/t", "closing speed before the collision", {}},
           {"kind", "1", "0 by the law, 1 below the cut-off or within the contact time, 2 merged", {}, 1, true}}};
}

Group sequence_table() {
  return {"sequence",
          {},
          {{"letters", "1", "gaps from the left that close one after the other", {}},
           {"repeats", "1", "how often these letters follow each other", {}},
           {"first", "1", "number of the first of these collisions, from 0", {}},
           {"time", "t", "time of that collision, rounded", {}}}};
}

Group initial_table() {
  return {
      "initial",
      {},
      {{"index", "1", "number of the particle, from the left", {}},
       {"x", "l", "position at the start", {}},
       {"v", "l/t", "velocity at the start", {}},
       {"m", "m", "mass", {}},
       {"gap", "l", "distance to the next particle: resolves what x cannot; nan behind the last one of a line", {}}}};
}

bool has_clouds(const Scene& scene) { return law_row(scene).merges && !scene.initial.on_ring(); }

ZoneAverage zone_average(const Scene& scene) {
  const Zone& zone = scene.output.zone;
  double reach = 0;
  if (zone.reach)
    reach = zone.reach->value;
  else
    try {
      const theory::WetShock<double> shock{
          .loss = scene.law.loss.value, .speed = scene.initial.speed.value, .spacing = scene.initial.spacing.value};
      reach = 3 * theory::WetZone<double>(shock).half_width();
    } catch (const std::domain_error& error) {
      throw Error({scene.name, 0, "output.zone.reach"}, "not given, and (13) has no answer", error.what(), "give it");
    }
  return {reach, zone.bins, zone.samples, 1.0};
}

namespace {

Group with_bins(Group histogram, const OctaveBins& bins) {
  std::vector<double> low = bins.low(), high(low.begin() + 1, low.end());
  high.push_back(std::numeric_limits<double>::infinity());
  histogram.columns[0].values = std::move(low);
  histogram.columns[1].values = std::move(high);
  return histogram;
}

Group with_error(Group table) {
  const Column& of = table.columns.back();
  table.columns.push_back({of.name + "_sem", of.unit, "standard error", {}});
  return table;
}

// Of the ring, or between walls at rest.
double length_of(const Scene& scene, const char* key) {
  if (const auto ends = extent(scene)) return ends->second.value - ends->first.value;
  throw Error({scene.name, 0, key}, "no length", "particles that are neither on a ring nor between walls at rest",
              "give output.structure.length, or remove this key");
}

std::vector<double> centres(const ZoneAverage& zone, std::size_t bins) {
  std::vector<double> x;
  for (std::size_t bin = 0; bin < bins; ++bin) x.push_back(zone.centre(bin));
  return x;
}

}  // namespace

Group zone_result(const ZoneAverage& zone, const ZoneWidth& width, const Scene& scene) {
  const Zone& wanted = scene.output.zone;
  Group table = filled(zone_table(), centres(zone, wanted.bins), zone.mass_density(), zone.density_right(),
                       zone.velocity_right(), zone.density_left(), zone.velocity_left());
  table.attributes = {{"from", wanted.from->value},
                      {"until", scene.run.until.value},
                      {"samples", std::uint64_t{zone.samples()}},
                      {"width", width.width},
                      {"width_error", width.error}};
  return table;
}

TimeAverages time_averages(const Scene& scene, std::size_t samples) {
  const Averages& wanted = scene.output.averages;
  return {{wanted.range[0].value, wanted.range[1].value}, wanted.bins, samples};
}

Group averages_result(const TimeAverages& averages, const Scene& scene) {
  const std::vector<TimeAverages::InBin> bins = averages.averages();
  std::vector<Numbers> columns{averages.centres()};
  for (std::size_t q = 0; q < TimeAverages::quantities; ++q) {
    std::vector<double> values, errors;
    for (const auto& [value, error] : bins) values.push_back(value[q]), errors.push_back(error[q]);
    columns.emplace_back(std::move(values));
    columns.emplace_back(std::move(errors));
  }
  Group table = filled(averages_table(), std::move(columns));
  table.attributes = {{"from", scene.output.averages.from.value},
                      {"until", scene.output.averages.until.value},
                      {"samples", std::uint64_t{averages.samples()}},
                      {"error_growth", averages.error_growth()}};
  return table;
}

OctaveBins histogram_bins(std::string_view name, const Scene& scene) {
  const auto& range = scene.output.counting.range;
  return histogram_row(name).of_numbers ? OctaveBins::of_numbers(range[0].value, range[1].value)
                                        : OctaveBins::of_counts();
}

Group histogram_result(std::string_view name, const OctaveHistogram& histogram, const Scene& scene) {
  Group table = with_bins(histogram_table(name), histogram.bins());
  table.columns.back().values = histogram.counts();
  table.attributes = {{"from", scene.output.counting.from.value}, {"until", scene.output.counting.until.value}};
  return table;
}

Group correlations_result(const Correlator& correlator, std::size_t particles, const Scene& scene) {
  const std::vector<Correlator::Correlation> all = correlator.correlations();
  Group table = correlations_table(scene);
  std::vector<double> displacement, of_displacement, velocity, of_velocity;
  std::vector<BatchMean> displacements;
  for (const auto& [x, v] : all) {
    displacement.push_back(x.mean), of_displacement.push_back(x.error);
    velocity.push_back(v.mean), of_velocity.push_back(v.error);
    displacements.push_back(x);
  }
  table = filled(table, table.columns.front().values, std::move(displacement), std::move(of_displacement),
                 std::move(velocity), std::move(of_velocity));
  table.attributes = {{"from", scene.output.correlations.from.value},
                      {"until", scene.output.correlations.until.value},
                      {"samples", correlator.samples()},
                      {"particles", std::uint64_t{particles}},
                      {"error_growth", error_growth(displacements)}};
  return table;
}

StructureFactor structure_factor(const Scene& scene) {
  const Structure& wanted = scene.output.structure;
  return {wanted.length ? wanted.length->value : length_of(scene, "output.structure"), wanted.waves};
}

PairDistribution pair_distribution(const Scene& scene) {
  const Pairs& wanted = scene.output.pair_distribution;
  return {wanted.distance.value, wanted.bins, length_of(scene, "output.pair_distribution"), scene.initial.on_ring()};
}

Group at_time(Group table, double time, std::vector<double> numbers) {
  table.columns.back().values = std::move(numbers);
  table.attributes = {{"time", time}};
  return table;
}

Group averaged(Group table, const SampledMeans& means, const PlaceTimes& wanted) {
  const std::vector<BatchMean> all = means.means();
  std::vector<double> values, errors;
  for (const BatchMean& m : all) values.push_back(m.mean), errors.push_back(m.error);
  table.columns.back().values = std::move(values);
  table = with_error(std::move(table));
  table.columns.back().values = std::move(errors);
  table.attributes = {{"from", wanted.from.value},
                      {"until", wanted.until.value},
                      {"samples", std::uint64_t{means.samples()}},
                      {"error_growth", error_growth(all)}};
  return table;
}

std::vector<std::pair<std::string, double>> scenario_numbers(const Scenario& s) {
  const bool met = s.passes + s.sticks > 0;
  return {{"pair_established", s.established},
          {"first_meeting", s.first_meeting},
          {"first_passed", met ? double(s.first_passed) : none<double>()},
          {"passes", static_cast<double>(s.passes)},
          {"sticks", static_cast<double>(s.sticks)},
          {"role_changes", static_cast<double>(s.role_changes)},
          {"regime", static_cast<double>(s.regime)},
          {"separation_exponent", s.separation_exponent},
          {"speed_exponent", s.speed_exponent}};
}

RunTables run_tables(const Scene& scene) {
  RunTables tables;
  if (scene.initial.type == InitialType::clusters) {
    tables.series = cluster_series_tables();
    return tables;
  }
  tables.series.push_back(series_table(scene));
  if (has_clouds(scene)) tables.series.push_back(heaviest_table());
  if (const Profiles& wanted = scene.output.profiles; !wanted.times.empty()) {
    tables.profile = profile_table("profiles");
    if (!wanted.range.empty())
      tables.profile->columns.front().values = bin_centres({wanted.range[0].value, wanted.range[1].value}, wanted.bins);
  }
  if (scene.output.zone.from) {
    tables.zone = zone_table();
    tables.zone->columns.front().values = centres(zone_average(scene), scene.output.zone.bins);
    tables.summary.emplace_back("zone_width");
  }
  if (scene.output.averages.every) {
    tables.averages = averages_table();
    tables.averages->columns.front().values = time_averages(scene, TimeAverages::batches).centres();
  }
  for (const HistogramRow& row : histograms)
    if (scene.output.has_histogram(row.name))
      tables.histograms.push_back(with_bins(histogram_table(row.name), histogram_bins(row.name, scene)));
  if (scene.output.correlations.every) tables.correlations = correlations_table(scene);
  const auto places = [&](const PlaceTimes& wanted, const std::string& name, const auto& table,
                          std::optional<Group>& mean, std::optional<Group>& at) {
    if (wanted.every) mean = with_error(table(name + "_average", scene));
    if (!wanted.times.empty()) at = table(name, scene);
  };
  places(scene.output.structure, "structure", structure_table, tables.structure_average, tables.structure);
  places(scene.output.pair_distribution, "pair_distribution", pair_distribution_table, tables.pair_distribution_average,
         tables.pair_distribution);
  if (scene.output.scenario)
    for (auto& [name, value] : scenario_numbers({})) tables.summary.push_back(name);
  return tables;
}

Group filled(Group table, std::vector<Numbers> columns) {
  if (columns.size() != table.columns.size())
    throw std::logic_error(
        fmt::format("a table /{} of {} columns, and numbers for {}", table.name, table.columns.size(), columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) table.columns[k].values = std::move(columns[k]);
  return table;
}

}  // namespace cradle::tools
