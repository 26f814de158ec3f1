// Each check is one function. All comparisons are exact, on the decimals.
#include "cradle/tools/scene/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "cradle/core/observe/averages.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/core/words/word.hpp"
#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/particle_order.hpp"

namespace cradle::tools {
namespace {

// Exact where the decimal has at most 100 digits, and beyond double's range.
bin_float number(const Decimal& decimal) { return from_text<bin_float>(decimal.text); }

class Checks {
 public:
  Checks(const Scene& scene, const Entries& entries, const std::string& scene_file)
      : scene_(scene), entries_(entries), scene_file_(scene_file) {}

  void rows_meet() const {
    if (!scene_.initial.general_rows()) return;
    const scene::Row& left = scene_.initial.left;
    const scene::Row& right = scene_.initial.right;
    const Centre& centre = scene_.initial.centre;
    if (left.speed <= right.speed)
      refuse("initial.right.speed", "the rows do not meet",
             fmt::format("left row at {}, right row at {}", left.speed.text, right.speed.text),
             "give the right row a lower velocity than the left row");
    if (centre.mass == Decimal("0")) {
      if (entries_.contains("initial.centre.speed") && !entries_.contains("initial.centre.mass"))
        refuse("initial.centre.speed", "speed of a particle that is not there", "initial.centre.mass = 0",
               "give initial.centre.mass too, or remove this key");
      return;
    }
    if (centre.speed > left.speed || centre.speed < right.speed)
      refuse("initial.centre.speed", "a row does not reach the particle between the rows",
             fmt::format("left row at {}, centre at {}, right row at {}", left.speed.text, centre.speed.text,
                         right.speed.text),
             "give a velocity between those of the rows");
  }

  void one_list_of_particles() const {
    const Initial& initial = scene_.initial;
    if (initial.type != InitialType::list) return;
    if (entries_.contains("initial.word")) return word_alone();
    const char* const given = entries_.contains("initial.x") ? "initial.x" : "initial.gap";
    const bool inline_particles = !initial.x.empty() || entries_.contains(given);
    if (initial.file && inline_particles)
      refuse("initial.file", "two lists of particles", std::string("initial.file and ") + given, "remove one of them");
    if (initial.file) {
      if (initial.file->empty())
        refuse("initial.file", "no file name", "an empty text", "name a CSV file of particles");
      for (const char* key : {"initial.v", "initial.m"})
        if (entries_.contains(key))
          refuse(key, "two lists of particles", "initial.file too", "put it into the file, or remove the file");
      return;
    }
    if (!inline_particles)
      refuse("initial.file", "missing", "",
             "name a CSV file of particles, or give initial.x (or initial.gap) and initial.v");
    if (initial.x.empty()) refuse("initial.x", "no particles", "an empty list", "give at least one position");
    same_length("initial.v", initial.v.size());
    if (entries_.contains("initial.m")) same_length("initial.m", initial.m.size());
    const bool gaps = entries_.contains("initial.gap");
    check_order({initial.x, initial.v, initial.m}, scene_.run,
                [&](std::size_t i) { return gaps ? item_place("initial.gap", i - 1) : item_place("initial.x", i); });
  }

  // A word says where its particles are and how they move.
  void word_alone() const {
    for (const char* key : {"initial.x", "initial.gap", "initial.v", "initial.file"})
      if (entries_.contains(key))
        refuse(key, "particles of a word and others", "initial.word too", "remove one of them");
    if (scene_.law.type != LawType::inelastic)
      refuse("initial.word", "words are of particles that bounce", *scene_.initial.file,
             "give law.type = \"inelastic\"");
    const auto wall_at = [&](const char* key, const WallAt& wall, const char* position) {
      if (!wall.position) return;
      if (*wall.position != Decimal(position) || wall.speed != Decimal("0") || wall.temperature || wall.shaken() ||
          wall.restitution != scene_.law.restitution)
        refuse(key, "not a wall of a word", wall.position->text,
               std::string("give a wall at ") + position + ", at rest, with the restitution of the particles");
    };
    wall_at("walls.left.position", scene_.walls.left, "0");
    wall_at("walls.right.position", scene_.walls.right, "1");
  }

  void two_clusters() const {
    const Initial& initial = scene_.initial;
    if (initial.type != InitialType::clusters) return;
    if (scene_.law.type != LawType::wet)
      refuse("initial.type", "clusters need the wet law", said("law.type"),
             "give law.type = \"wet\" or another initial state");
    for (const auto& [key, numbers] :
         {std::pair("initial.x", initial.x.size()), std::pair("initial.v", initial.v.size()),
          std::pair("initial.growth", initial.growth.size())})
      if (numbers != 2)
        refuse(key, "not one per cluster", fmt::format("{} for two clusters", numbers), "give two numbers");
    if (std::is_lteq(compare_decimals(initial.x[1], initial.x[0])))
      throw Error(item_place("initial.x", 1), "not increasing", fmt::format("{} after {}", initial.x[1], initial.x[0]),
                  "give the left cluster first");
    if (scene_.run.start < Decimal("0"))
      refuse("run.start", "before the clusters begin to grow", scene_.run.start.text, "give 0 or more");
    try {
      theory::WetZone<double>({scene_.law.loss.value, initial.speed.value, initial.spacing.value});
    } catch (const std::domain_error& error) {
      refuse("law.loss", error.what(), scene_.law.loss.text, "give another loss or initial.speed");
    }
    for (const Field& field : scene_fields()) {
      const std::string_view key = field.key;
      if (!key.starts_with("output.") || key.starts_with("output.series.") || key.starts_with("output.checkpoint.") ||
          key == "output.profiles.bins" || key == "output.profiles.range" || key == "output.every_replica")
        continue;
      if (!field.when->holds(scene_)) continue;
      if (const auto text = value_text(field, scene_); text && *text != "[]" && *text != "false")
        refuse(key, "nothing to write", "two clusters in the force of particles that are not there", "remove it");
    }
  }

  // If particles are displaced at random, each replica is checked when it is set up (core/initial/walled.hpp).
  void walls_stand() const {
    const auto& [left, right] = scene_.walls;
    if (!scene_.walls.any()) return;
    const std::string first = left.position ? "walls.left.position" : "walls.right.position";
    const Initial& initial = scene_.initial;
    if (initial.on_ring() || initial.type == InitialType::clusters)
      refuse(first, "a wall without a line of particles", said("initial.type"),
             "remove [walls], or give particles on a line");
    if (scene_.run.collapse == scene::CollapsePolicy::merge)
      refuse(first, "a wall for particles that merge", "run.collapse = \"merge\"",
             "remove [walls], or choose another collapse policy");
    if (scene_.output.core)
      refuse("output.core", "nothing to compare the core with", "walls, which the sticky gas does not have",
             "remove it");
    const auto among = [&](const char* key, const Decimal& wall, const std::string& particle) {
      refuse(key, "a wall among the particles, which would have met before the start",
             fmt::format("wall at {}, {}", wall.text, particle), "move it outwards");
    };
    walls_shake();
    particles_can_rest();
    // Shaken walls are checked where they are at the start (core/initial/walled.hpp).
    const bool listed = initial.type == InitialType::list && !initial.x.empty();
    for (const auto& [key, wall, side, which] : {std::tuple("walls.left.position", &left, -1, "first"),
                                                 std::tuple("walls.right.position", &right, 1, "last")}) {
      if (!wall->position || wall->shaken()) continue;
      if (listed) {
        const auto at = side < 0 ? initial.x[0] : initial.x.back();
        if (const auto order = compare_decimals(wall->position->text, at);
            side < 0 ? std::is_gteq(order) : std::is_lteq(order))
          among(key, *wall->position, fmt::format("{} particle at {}", which, at));
      } else if (const auto at = outermost(side); at && !(bin_float(side) * (number(*wall->position) - *at) > 0)) {
        among(key, *wall->position, fmt::format("{} particle at {:g}", which, static_cast<double>(*at)));
      }
    }
    if (!left.position || !right.position) return;
    bin_float gap = number(*right.position) - number(*left.position);
    for (const WallAt* wall : {&left, &right})
      if (wall->shaken()) gap -= number(wall->amplitude);
    if (!(gap > 0))
      refuse(left.shaken() ? "walls.left.amplitude" : "walls.right.amplitude", "walls that can meet",
             fmt::format("as near as {:g}", static_cast<double>(gap)),
             "give smaller amplitudes, or positions further apart");
    const bin_float closing = number(left.speed) - number(right.speed);
    const bin_float span = number(scene_.run.until) - number(scene_.run.start);
    if (gap - closing * span > 0) return;
    refuse(left.speed == Decimal("0") ? "walls.right.speed" : "walls.left.speed", "the walls meet before the run ends",
           fmt::format("at t = {:g}", static_cast<double>(number(scene_.run.start) + gap / closing)),
           "give smaller speeds, or an earlier run.until");
  }

  void walls_shake() const {
    for (const auto& [name, wall] :
         {std::pair("walls.left.", &scene_.walls.left), std::pair("walls.right.", &scene_.walls.right)}) {
      const double span = scene_.run.until.value - scene_.run.start.value;
      if (wall->shaken() && !(wall->frequency.value * span + std::abs(wall->phase.value) < 1e15))
        refuse(name + std::string("frequency"), "more periods than can be counted",
               fmt::format("frequency {}, phase {}, for a time of {:g}", wall->frequency.text, wall->phase.text, span),
               "give a smaller frequency or phase, or an earlier run.until");
      if (wall->rest_speed && scene_.run.coordinates == Coordinates::absolute)
        refuse(name + std::string("rest_speed"), "a particle that rests, in absolute positions", wall->rest_speed->text,
               "give run.coordinates = \"gaps\"");
      if (wall->shaken() && !wall->temperature && wall->restitution == Decimal("0") && !wall->rest_speed)
        refuse(name + std::string("restitution"), "a shaken wall on which particles come to rest", "0",
               "give it a rest_speed, or a small restitution, 0.01 or so");
    }
  }

  // Several particles rest at one end only, and not between two shaken walls.
  void particles_can_rest() const {
    const auto& [left, right] = scene_.walls;
    if (!left.position || !right.position || !(left.rest_speed || right.rest_speed)) return;
    if (scene_.initial.type == InitialType::list && scene_.initial.x.size() < 2) return;
    if (left.rest_speed && right.rest_speed)
      refuse("walls.right.rest_speed", "two walls on which several particles can rest", right.rest_speed->text,
             "leave it out at one of them");
    if (left.shaken() && right.shaken())
      refuse(left.rest_speed ? "walls.left.rest_speed" : "walls.right.rest_speed",
             "several particles that rest between two shaken walls", "both walls have a motion",
             "leave out one motion, or the rest_speed");
  }

  void particles_can_fall() const {
    if (!scene_.gravity.acts()) return;
    const Initial& initial = scene_.initial;
    const std::string& acceleration = scene_.gravity.acceleration->text;
    if (initial.on_ring())
      refuse("gravity.acceleration", "gravity on a ring, which has no ends to fall to", acceleration,
             "remove [gravity], or give particles on a line");
    if (initial.type == InitialType::clusters)
      refuse("gravity.acceleration", "gravity on two clusters, which have a force of their own", acceleration,
             "remove [gravity], or give another initial state");
    if (scene_.run.collapse == scene::CollapsePolicy::merge)
      refuse("gravity.acceleration", "gravity on particles that merge", "run.collapse = \"merge\"",
             "choose another collapse policy; below the rest_speed of a floor particles stay on it");
    if (scene_.output.core)
      refuse("output.core", "nothing to compare the core with", "gravity, which the sticky gas does not have",
             "remove it");
    const bool to_left = *scene_.gravity.acceleration < Decimal("0");
    const WallAt& floor = to_left ? scene_.walls.left : scene_.walls.right;
    if (floor.position && !floor.temperature && floor.restitution == Decimal("0") && !floor.rest_speed)
      refuse(to_left ? "walls.left.restitution" : "walls.right.restitution", "a floor on which particles come to rest",
             "0", "give it a rest_speed, or a small restitution, 0.01 or so");
  }

  void gas_between_walls() const {
    const Initial& initial = scene_.initial;
    if (initial.type != InitialType::gas) return;
    if (law_row(scene_).merges)
      refuse("initial.type", "a gas between walls needs a law that bounces", said("law.type"),
             "give law.type = \"inelastic\" or another initial state");
    const Decimal &left = *scene_.walls.left.position, &right = *scene_.walls.right.position;
    if (right <= left)
      refuse("walls.right.position", "walls without room for a gas",
             fmt::format("from {} to {}", left.text, right.text), "give the left wall a lower position");
    Scene other = scene_;
    const Field& end = *find_field("walls.right.position", scene_);
    store_default(end, other);
    if (initial.density && *other.walls.right.position != right)
      refuse("initial.density", "a density and both walls",
             fmt::format("density {}, walls at {} and {}", initial.density->text, left.text, right.text),
             "remove initial.density or walls.right.position");
  }

  void random_masses() const {
    if (!entries_.contains("initial.random_masses")) return;
    if (entries_.contains("initial.masses"))
      refuse("initial.random_masses", "two ways to give masses", "initial.masses too", "remove one of them");
    rising("initial.random_masses", scene_.initial.random_masses, "not a range of masses",
           "give two masses, the smaller one first");
  }

  void masses_repeat() const {
    const Initial& initial = scene_.initial;
    masses_fit();
    if (!entries_.contains("initial.masses")) return;
    const std::size_t period = initial.masses.size();
    if (period == 0) refuse("initial.masses", "no masses", "an empty list", "give at least one mass");
    if (initial.type == InitialType::ring && initial.particles % period != 0)
      refuse("initial.masses", "the pattern does not divide the ring",
             fmt::format("{} masses, {} particles", period, initial.particles),
             fmt::format("give initial.particles as a multiple of {}", period));
  }

  void masses_fit() const {
    if (!unequal_masses(scene_)) return;
    const std::string given = scene_.initial.random_masses.empty() ? "initial.masses" : "initial.random_masses";
    if (scene_.output.scenario || scene_.output.zone.from)
      refuse(scene_.output.scenario ? "output.scenario" : "output.zone.from", "for particles of mass 1",
             given + " of others", "remove one of the two");
  }

  void policy_of_law() const {
    const auto policy = scene_.run.collapse;
    const bool merge_or_time = policy == scene::CollapsePolicy::contact_time || policy == scene::CollapsePolicy::merge;
    if (merge_or_time && !law_row(scene_).policies)
      refuse("run.collapse", "collapse policy of another law", said("law.type"),
             "remove it, it belongs to law.type = \"inelastic\"");
    if (!scene_.law.cutoff_exponent) return;
    if (!(scene_.law.cutoff > Decimal("0")))
      refuse("law.cutoff_exponent", "no cut-off that sets in", "law.cutoff = 0",
             "give law.cutoff too, or remove this key");
    if (merge_or_time)
      refuse("run.collapse", "not built with a restitution that depends on the speed",
             value_text(*find_field("run.collapse", scene_), scene_).value(),
             "give run.collapse = \"cutoff\" or \"stop\", or remove law.cutoff_exponent");
  }

  void series_has_times() const {
    if (entries_.contains("output.series.times") && scene_.output.series.times.empty())
      refuse("output.series.times", "no times", "an empty list", "give at least one time");
  }

  void ranges_of_bins() const {
    range_of_bins("output.profiles.range", scene_.output.profiles.range, scene_.output.profiles.bins);
    range_of_bins("output.averages.range", scene_.output.averages.range, scene_.output.averages.bins);
    range_of_bins("output.counting.range", scene_.output.counting.range);
  }

  void averages_have_bins_and_samples() const {
    const Averages& averages = scene_.output.averages;
    if (!averages.every) return;
    if (averages.range.empty())
      refuse("output.averages.range", "missing", "particles that are neither on a ring nor between walls",
             "give two positions, the lower one first");
    const bin_float span = number(averages.until) - number(averages.from);
    if (const auto least = number(*averages.every) * bin_float(static_cast<std::int64_t>(TimeAverages::batches - 1));
        span < least)
      refuse("output.averages.every", "too few samples for errors", averages.every->text,
             fmt::format("give {:g} or less, for {} samples at least",
                         static_cast<double>(span) / (TimeAverages::batches - 1), TimeAverages::batches));
  }

  void pairs_stay_together() const {
    if (scene_.output.has_histogram("pair_flight") && particles_merge(scene_))
      refuse("output.histograms", "pairs that do not stay neighbours", "pair_flight of particles that merge",
             "leave out pair_flight");
  }

  void tagged_particles_stay_in_order() const {
    if (scene_.output.correlations.every && particles_merge(scene_))
      refuse("output.correlations.every", "tagged particles that do not stay what they are", "particles that merge",
             "remove it");
  }

  // A ring whose length is in another result is known later.
  void places_are_on_a_length() const {
    const auto ends = extent(scene_);
    const Structure& structure = scene_.output.structure;
    const Pairs& pairs = scene_.output.pair_distribution;
    constexpr const char* neither = "particles that are neither on a ring nor between walls at rest";
    if (!ends && scene_.initial.file) return;
    if (structure.any() && !structure.length && !ends)
      refuse("output.structure.length", "missing", neither, "give the length of the longest wave");
    if (structure.any() && structure.length && ends && scene_.initial.on_ring()) {
      // A quotient of decimals that is whole is so within rounding.
      const bin_float waves = number(ends->second) / number(*structure.length), whole = round(waves);
      if (whole == 0 || abs(bin_float(waves - whole)) > waves * std::numeric_limits<bin_float>::epsilon())
        refuse("output.structure.length", "waves that do not close on the ring", structure.length->text,
               fmt::format("remove it, or give the length of the ring, {}, or a whole part of it", ends->second.text));
    }
    if (!pairs.any()) return;
    const std::string_view key = pairs.every ? "output.pair_distribution.every" : "output.pair_distribution.times";
    if (!ends) refuse(key, "pairs without a density to compare them with", neither, "remove it");
    const bin_float length = number(ends->second) - number(ends->first);
    const bin_float most = scene_.initial.on_ring() ? bin_float(length / bin_float(2)) : length;
    if (number(pairs.distance) > most)
      refuse("output.pair_distribution.distance",
             scene_.initial.on_ring() ? "more than half of the ring" : "more than there is between the walls",
             pairs.distance.text, fmt::format("give {:g} at most", static_cast<double>(most)));
  }

  void numbers_fit() const {
    const NumberRange of_type(scene_.run), of_doubles{Run()};
    for (const Field& field : scene_fields()) {
      if (!field.when->holds(scene_)) continue;
      const NumberRange& range = is_double_anyway(field.key) ? of_doubles : of_type;
      for (const Decimal& number : numbers_of(field, scene_)) {
        range.check(number.text, place(field.key));
        // A number above 0 in the scene must be above 0 in the run. The particle between the rows may have mass 0.
        const bool above_zero =
            field.range.starts_with("(0,") || (field.key == "initial.centre.mass" && number > Decimal("0"));
        if (above_zero) range.check_positive(number.text, place(field.key));
      }
    }
  }

  // Called before memory for the samples is allocated.
  void samples_can_be_kept() const {
    constexpr double most = 1e7;  // as for points in the table of keys
    const Series& series = scene_.output.series;
    const bin_float start = number(scene_.run.start), span = number(scene_.run.until) - start;
    const auto one_scale = [&](const char* key, const Decimal& a, const Decimal& b) {
      for (const Decimal& end : {scene_.run.start, scene_.run.until})
        if (!of_one_scale(end, a, b))
          refuse(key, "times of thousands of digits", b.text, "give it and the ends of the run fewer digits");
    };
    const auto check = [&](const char* key, const Decimal& given, const bin_float& step) {
      one_scale(key, scene_.run.start, given);
      const auto samples = static_cast<double>(bin_float(span / step));
      if (!(samples <= most))
        refuse(key, "too many samples",
               fmt::format("{}, which makes {:.3g} of them until run.until", given.text, samples),
               fmt::format("give a longer time, {:.0g} samples at most", most));
    };
    for (const auto& [key, every] :
         {std::pair("output.averages.every", scene_.output.averages.every),
          std::pair("output.counting.every", scene_.output.counting.every),
          std::pair("output.correlations.every", scene_.output.correlations.every),
          std::pair("output.structure.every", scene_.output.structure.every),
          std::pair("output.pair_distribution.every", scene_.output.pair_distribution.every)})
      if (every) check(key, *every, number(*every));
    if (scene_.output.zone.from) one_scale("output.zone.from", scene_.run.start, *scene_.output.zone.from);
    if (series.every) return check("output.series.every", *series.every, number(*series.every));
    if (series.points) one_scale("run.until", scene_.run.start, scene_.run.until);
    if (!series.over) return;
    const bin_float over = number(*series.over) - start, points(static_cast<std::int64_t>(*series.points - 1));
    if (series.spacing == Spacing::linear) return check("output.series.over", *series.over, over / points);
    // Each additional decade adds a sixth of the points, which cover six decades.
    const double decades = std::log10(static_cast<double>(bin_float(span / over)));
    check("output.series.over", *series.over, span / (points * bin_float(1 + decades / 6)));
  }

 private:
  // `places`: how many bins are places of particles.
  void range_of_bins(const char* key, const std::vector<Decimal>& range, std::uint64_t places = 0) const {
    if (!entries_.contains(key)) return;
    rising(key, range, "not a range",
           std::string_view(key) == "output.counting.range" ? "give two numbers, the lower one first"
                                                            : "give two positions, the lower one first");
    if (!(range[0].value < range[1].value) || !std::isfinite(range[1].value - range[0].value))
      refuse(key, "not a range of doubles, in which bins are",
             fmt::format("from {} to {}", range[0].text, range[1].text), "give ends that doubles distinguish");
    const auto ring = places > 0 && scene_.initial.on_ring() ? extent(scene_) : std::nullopt;
    if (!ring) return;
    const bin_float most = number(ring->second) * bin_float(places);
    if (number(range[1]) - number(range[0]) > most)
      refuse(key, "bins longer than the ring", fmt::format("from {} to {}", range[0].text, range[1].text),
             fmt::format("give a range of {:g} at most, or more bins", static_cast<double>(most)));
  }

  void rising(const char* key, const std::vector<Decimal>& range, const char* what, const char* advice) const {
    if (range.size() != 2 || range[0] >= range[1])
      refuse(key, what,
             range.size() == 2 ? fmt::format("from {} to {}", range[0].text, range[1].text)
                               : describe(entries_.find(key)->second),
             advice);
  }

  // Random speeds of thermal walls and averages are doubles in every working precision.
  static bool is_double_anyway(std::string_view key) {
    return key.ends_with(".temperature") || key == "output.zone.reach" || key == "output.counting.range" ||
           key == "output.structure.length" || key == "output.pair_distribution.distance";
  }

  std::string said(const std::string& key) const {
    return key + " = " + value_text(*find_field(key, scene_), scene_).value();
  }

  [[noreturn]] void refuse(std::string_view key, std::string_view wrong, std::string_view found,
                           std::string_view advice) const {
    throw Error(place(key), wrong, found, advice);
  }

  Place place(std::string_view key) const {
    const auto entry = entries_.find(key);
    return entry == entries_.end() ? Place{scene_file_, 0, std::string(key)} : entry->second.place;
  }

  Place item_place(std::string_view key, std::size_t i) const {
    const auto entry = entries_.find(key);
    return entry == entries_.end() ? place(key) : entry->second.items.at(i).place;
  }

  // The outermost possible position of a particle on one side at the start. Nothing if it is known only after particles
  // are set up.
  std::optional<bin_float> outermost(int side) const {
    const Initial& initial = scene_.initial;
    if (initial.type != InitialType::rows || initial.positions != Positions::lattice) return {};
    const scene::Row& row = side < 0 ? initial.left : initial.right;
    const bin_float spacing = initial.general_rows() ? bin_float(1) / number(row.density) : number(initial.spacing);
    const bin_float particles(
        static_cast<std::int64_t>(initial.general_rows() ? row.particles : initial.particles / 2));
    return bin_float(side) * (particles - bin_float(1) / bin_float(2) + number(initial.perturbation)) * spacing;
  }

  void same_length(std::string_view key, std::size_t length) const {
    const std::size_t particles = scene_.initial.x.size();
    if (length != particles)
      refuse(key, "not one per particle", fmt::format("{} for {} positions", length, particles),
             fmt::format("give {} numbers", particles));
  }

  const Scene& scene_;
  const Entries& entries_;
  const std::string& scene_file_;
};

}  // namespace

void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file) {
  const Checks checks(scene, entries, scene_file);
  checks.rows_meet();
  checks.one_list_of_particles();
  checks.two_clusters();
  checks.gas_between_walls();
  checks.walls_stand();
  checks.particles_can_fall();
  checks.random_masses();
  checks.masses_repeat();
  checks.policy_of_law();
  checks.series_has_times();
  checks.ranges_of_bins();
  checks.averages_have_bins_and_samples();
  checks.pairs_stay_together();
  checks.tagged_particles_stay_in_order();
  checks.places_are_on_a_length();
  checks.numbers_fit();
  checks.samples_can_be_kept();
}

void check_word(const Place& place, const Scene& scene) {
  if (particles_merge(scene) || scene.initial.on_ring())
    throw Error(place, "letters are of particles on a line that bounce",
                scene.initial.on_ring() ? "a ring" : "particles that merge", "remove it, or give output.events");
  const std::size_t gaps = scene.gaps(), most = 26;
  if (gaps < 2 || gaps > most)
    throw Error(place, "not a few particles", fmt::format("{} gaps", gaps), fmt::format("give 2 to {}", most));
  if (*scene.output.word == any_word) return;
  try {
    words::read_word(*scene.output.word, gaps);
  } catch (const words::BadWord& bad) {
    throw Error(place, bad.what(), bad.found, bad.advice);
  }
}

}  // namespace cradle::tools
