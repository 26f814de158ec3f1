// What a run does and writes. Each check is one function. All comparisons are exact, on the decimals.
#include "cradle/tools/scene/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <compare>
#include <limits>
#include <utility>

#include "cradle/core/observe/averages.hpp"

namespace cradle::tools {
namespace {

// `places`: how many bins are places of particles.
void range_of_bins(const Checked& of, const char* key, const std::vector<Decimal>& range, std::uint64_t places = 0) {
  if (!of.entries.contains(key)) return;
  of.rising(key, range, "not a range",
            std::string_view(key) == "output.counting.range" ? "give two numbers, the lower one first"
                                                             : "give two positions, the lower one first");
  if (!(range[0].value < range[1].value) || !std::isfinite(range[1].value - range[0].value))
    of.refuse(key, "not a range of doubles, in which bins are",
              fmt::format("from {} to {}", range[0].text, range[1].text), "give ends that doubles distinguish");
  const auto ring = places > 0 && of.scene.initial.on_ring() ? extent(of.scene) : std::nullopt;
  if (!ring) return;
  const bin_float most = precise(ring->second) * bin_float(places);
  if (precise(range[1]) - precise(range[0]) > most)
    of.refuse(key, "bins longer than the ring", fmt::format("from {} to {}", range[0].text, range[1].text),
              fmt::format("give a range of {} at most, or more bins", static_cast<double>(most)));
}

// Random speeds of thermal walls, displacements and averages are doubles in every working precision.
bool is_double_anyway(std::string_view key) {
  return key.ends_with(".temperature") || key.ends_with(".range") || key == "output.zone.reach" ||
         key == "output.structure.length" || key == "output.pair_distribution.distance" ||
         key == "initial.perturbation" || key == "initial.density_exponent";
}

void policy_of_law(const Checked& of) {
  const auto policy = of.scene.run.collapse;
  const bool merge_or_time = policy == scene::CollapsePolicy::contact_time || policy == scene::CollapsePolicy::merge;
  if (merge_or_time && !law_row(of.scene).policies)
    of.refuse("run.collapse", "collapse policy of another law", of.said("law.type"),
              "remove it, it belongs to law.type = \"inelastic\"");
  if (!of.scene.law.cutoff_exponent) return;
  if (!(of.scene.law.cutoff > Decimal("0")))
    of.refuse("law.cutoff_exponent", "no cut-off that sets in", "law.cutoff = 0",
              "give law.cutoff too, or remove this key");
  if (merge_or_time)
    of.refuse("run.collapse", "not built with a restitution that depends on the speed",
              value_text(*find_field("run.collapse", of.scene), of.scene).value(),
              "give run.collapse = \"cutoff\" or \"stop\", or remove law.cutoff_exponent");
}

void series_has_times(const Checked& of) {
  if (of.entries.contains("output.series.times") && of.scene.output.series.times.empty())
    of.refuse("output.series.times", "no times", "an empty list", "give at least one time");
}

void ranges_of_bins(const Checked& of) {
  range_of_bins(of, "output.profiles.range", of.scene.output.profiles.range, of.scene.output.profiles.bins);
  range_of_bins(of, "output.averages.range", of.scene.output.averages.range, of.scene.output.averages.bins);
  range_of_bins(of, "output.counting.range", of.scene.output.counting.range);
}

void averages_have_bins_and_samples(const Checked& of) {
  const Averages& averages = of.scene.output.averages;
  if (!averages.every) return;
  if (averages.range.empty())
    of.refuse("output.averages.range", "missing", "particles that are neither on a ring nor between walls",
              "give two positions, the lower one first");
  const bin_float span = precise(averages.until) - precise(averages.from);
  if (const auto least = precise(*averages.every) * bin_float(static_cast<std::int64_t>(TimeAverages::batches - 1));
      span < least)
    of.refuse("output.averages.every", "too few samples for errors", averages.every->text,
              fmt::format("give {:g} or less, for {} samples at least",
                          static_cast<double>(span) / (TimeAverages::batches - 1), TimeAverages::batches));
}

void particles_stay_apart(const Checked& of) {
  if (!particles_merge(of.scene)) return;
  if (of.scene.output.has_histogram("pair_flight"))
    of.refuse("output.histograms", "pairs that do not stay neighbours", "pair_flight of particles that merge",
              "leave out pair_flight");
  if (of.scene.output.correlations.every)
    of.refuse("output.correlations.every", "tagged particles that do not stay what they are", "particles that merge",
              "remove it");
}

void core_on_a_line(const Checked& of) {
  const char* found = of.scene.walls.any()         ? "walls"
                      : of.scene.gravity.acts()    ? "gravity"
                      : of.scene.initial.on_ring() ? "a ring"
                                                   : nullptr;
  if (of.scene.output.core && found)
    of.refuse("output.core", "nothing to compare the core with",
              fmt::format("{}, which the sticky gas does not have", found), "remove it");
}

// A ring whose length is in another result is known later.
void places_are_on_a_length(const Checked& of) {
  const auto ends = extent(of.scene);
  const Structure& structure = of.scene.output.structure;
  const Pairs& pairs = of.scene.output.pair_distribution;
  constexpr const char* neither = "particles that are neither on a ring nor between walls at rest";
  if (!ends && of.scene.initial.file) return;
  if (structure.any() && !structure.length && !ends)
    of.refuse("output.structure.length", "missing", neither, "give the length of the longest wave");
  if (structure.any() && structure.length && ends && of.scene.initial.on_ring()) {
    // A quotient of decimals that is whole is so within rounding.
    const bin_float waves = precise(ends->second) / precise(*structure.length), whole = round(waves);
    if (whole == 0 || abs(bin_float(waves - whole)) > waves * std::numeric_limits<bin_float>::epsilon())
      of.refuse("output.structure.length", "waves that do not close on the ring", structure.length->text,
                fmt::format("remove it, or give the length of the ring, {}, or a whole part of it", ends->second.text));
  }
  if (!pairs.any()) return;
  const std::string_view key = pairs.every ? "output.pair_distribution.every" : "output.pair_distribution.times";
  if (!ends) of.refuse(key, "pairs without a density to compare them with", neither, "remove it");
  const bin_float length = precise(ends->second) - precise(ends->first);
  const bin_float most = of.scene.initial.on_ring() ? bin_float(length / bin_float(2)) : length;
  if (precise(pairs.distance) > most)
    of.refuse("output.pair_distribution.distance",
              of.scene.initial.on_ring() ? "more than half of the ring" : "more than there is between the walls",
              pairs.distance.text, fmt::format("give {} at most", static_cast<double>(most)));
}

void numbers_fit(const Checked& of) {
  const NumberRange of_type(of.scene.run), of_doubles{Run()};
  for (const Field& field : scene_fields()) {
    if (!field.when->holds(of.scene) || !field.recorded) continue;
    const NumberRange& range = is_double_anyway(field.key) ? of_doubles : of_type;
    for (const Decimal& number : numbers_of(field, of.scene)) range.check(number.text, of.place(field.key));
  }
}

// Squares of speeds that underflow belong to pairs that have less energy than this, also in heavy clusters.
void loss_is_above_rounding(const Checked& of) {
  const ScalarRow& type = scalar_row(of.scene.run.precision);
  const Decimal& loss = of.scene.law.loss;
  if (of.scene.law.type == LawType::wet && !type.least.empty() && loss > Decimal("0") &&
      precise(loss) < from_text<bin_float>(type.least) * from_text<bin_float>("1e20"))
    of.refuse("law.loss", "too small for the precision", fmt::format("{} with \"{}\"", loss.text, type.name),
              "give a larger number, 0 or another run.precision");
}

void zone_has_a_width(const Checked& of) {
  if (!of.scene.output.zone.from || of.scene.output.zone.reach) return;
  if (const std::string without = without_zone(of.scene); !without.empty())
    of.refuse("output.zone.reach", "missing, and (13) has no answer", of.said("law.loss"), "give it: " + without);
}

// Called before memory for the samples is allocated.
void samples_can_be_kept(const Checked& of) {
  constexpr double most = 1e7;  // as for points in the table of keys
  const Series& series = of.scene.output.series;
  const bin_float start = precise(of.scene.run.start), span = precise(of.scene.run.until) - start;
  const auto one_scale = [&](std::string_view key, const Decimal& a, const Decimal& b) {
    for (const Decimal& end : {of.scene.run.start, of.scene.run.until})
      if (!of_one_scale(end, a, b))
        of.refuse(key, "times of thousands of digits", b.text, "give it and the ends of the run fewer digits");
  };
  const auto check = [&](std::string_view key, const Decimal& given, const bin_float& step) {
    one_scale(key, of.scene.run.start, given);
    const auto samples = static_cast<double>(bin_float(span / step));
    if (!(samples <= most))
      of.refuse(key, "too many samples",
                fmt::format("{}, which makes {:.3g} of them until run.until", given.text, samples),
                fmt::format("give a longer time, {:.0g} samples at most", most));
  };
  for (const Field& field : scene_fields())
    if (field.key.starts_with("output.") && field.key.ends_with(".every"))
      for (const Decimal& every : numbers_of(field, of.scene)) check(field.key, every, precise(every));
  if (of.scene.output.zone.from) one_scale("output.zone.from", of.scene.run.start, *of.scene.output.zone.from);
  if (series.points) one_scale("run.until", of.scene.run.start, of.scene.run.until);
  if (!series.over) return;
  const bin_float over = precise(*series.over) - start, points(static_cast<std::int64_t>(*series.points - 1));
  if (series.spacing == Spacing::linear) return check("output.series.over", *series.over, over / points);
  // Each additional decade adds a sixth of the points, which cover six decades.
  const double decades = std::log10(static_cast<double>(bin_float(span / over)));
  check("output.series.over", *series.over, span / (points * bin_float(1 + decades / 6)));
}

}  // namespace

void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file) {
  const Checked of{scene, entries, scene_file};
  check_state(of);
  for (const auto check : {policy_of_law, series_has_times, ranges_of_bins, averages_have_bins_and_samples,
                           particles_stay_apart, core_on_a_line, places_are_on_a_length, numbers_fit,
                           loss_is_above_rounding, zone_has_a_width, samples_can_be_kept})
    check(of);
}

void NumberRange::check(std::string_view literal, const Place& place) const {
  if (type_.largest.empty() || (literal.size() < 300 && literal.find_first_of("eE") == literal.npos)) return;
  const auto size = literal.substr(literal.starts_with('-') ? 1 : 0);
  const bool small = std::is_lt(compare_decimals(size, type_.least));
  if (small ? std::is_eq(compare_decimals(size, "0")) : std::is_lteq(compare_decimals(size, type_.largest))) return;
  throw Error(place, small ? "too small for the precision" : "too large for the precision",
              fmt::format("{} with \"{}\"", literal, type_.name),
              fmt::format("give a {} number or another run.precision", small ? "larger" : "smaller"));
}

void check_neighbours(const DecimalColumn& x, const DecimalColumn& v, std::size_t right, const NumberRange& range,
                      const Place& place) {
  const std::size_t left = right - 1;
  const auto order = compare_decimals(x[right], x[left]);
  if (std::is_gt(order)) return range.check(difference(x[right], x[left]), place);
  const auto places = fmt::format("{} after {}", x[right], x[left]);
  if (std::is_lt(order)) throw Error(place, "not increasing", places, "give the particles in order of increasing x");
  if (std::is_gt(compare_decimals(v[left], v[right])))
    throw Error(place, "particles that touch and approach", places,
                "give them the velocities that they have after this collision, or a distance: initial.gap, or a column "
                "gap, with 1e-300 there");
}

void check_order(const DecimalColumn& x, const DecimalColumn& v, const Run& run,
                 const std::function<Place(std::size_t)>& before) {
  const NumberRange range(run);
  for (std::size_t right = 1; right < x.size(); ++right) check_neighbours(x, v, right, range, before(right));
}

}  // namespace cradle::tools
