// A scene: which particles, which collision law, until when, and what to write. Plain values, read from TOML.
// Units: mass m = 1, lengths in the scene's own unit, times in lengths per speed. All keys, units, defaults and ranges
// are in the one table of fields.cpp; this struct only holds what was read. Numbers are exact decimals
// (decimal.hpp), to be converted in the working precision from Decimal::text.
// A member whose key does not apply to the scene's law, initial state or policy keeps the value written here.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/tools/scene/choices.hpp"
#include "cradle/tools/scene/decimal.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

// The enumerators are in the order of the names in the table of fields.
enum class Coordinates { gaps, absolute };
enum class Spacing { linear, log };

// Scene types whose names the engine uses too.
namespace scene {

enum class Motion { none, sawtooth, parabola, sine };
enum class CollapsePolicy { cutoff, contact_time, merge, stop };

}  // namespace scene

/// A wall at one end of the line; without a position there is none.
struct WallAt {
  std::optional<Decimal> position;     // at run.start
  Decimal speed;                       // positive to the right
  std::optional<Decimal> temperature;  // of a thermal wall; without one it reflects
  Decimal restitution;                 // of a reflecting wall
  scene::Motion motion = scene::Motion::none;
  Decimal amplitude, frequency, phase;  // of a shaken wall; the frequency is angular
  std::optional<Decimal> rest_speed;    // below it particles rest on it
  bool shaken() const { return motion != scene::Motion::none; }
  bool dissipates() const { return position && !temperature && restitution < Decimal("1"); }
};

struct WallPair {
  WallAt left, right;
  bool any() const { return left.position || right.position; }
  bool shaken() const { return left.shaken() || right.shaken(); }
};

struct GravityOf {
  std::optional<Decimal> acceleration;  // of all particles, positive to the right
  bool acts() const { return acceleration && *acceleration != Decimal("0"); }
};

struct Run {
  Decimal start;
  Decimal until;
  Precision precision = Precision::double_;
  std::uint64_t digits = 0;  // mpfr
  Coordinates coordinates = Coordinates::gaps;
  scene::CollapsePolicy collapse = scene::CollapsePolicy::stop;
  Decimal contact_time;             // contact-time
  Decimal merge_speed;              // merge
  std::optional<Decimal> stop_gap;  // stop

  /// How many decimal digits numbers of the working precision have.
  unsigned decimal_digits() const {
    const unsigned own = scalar_row(precision).digits;
    return own > 0 ? own : static_cast<unsigned>(digits);
  }
};

/// When samples are taken; exactly one of points, every and times is given.
struct Series {
  std::optional<std::uint64_t> points;
  Spacing spacing = Spacing::linear;  // of points
  std::optional<Decimal> over;        // of points: end of the range in which they are spread; none: end of the run
  std::optional<Decimal> every;
  std::vector<Decimal> times;
};

struct Profiles {
  std::vector<Decimal> times;
  std::uint64_t bins = 0;
  std::vector<Decimal> range;  // {from, to}; empty: the interaction zone at that time
};

/// Average over the interaction zone of a wet shock, from a given time on; without one there is no average.
struct Zone {
  std::optional<Decimal> from;
  std::uint64_t samples = 0;
  std::uint64_t bins = 0;
  std::optional<Decimal> reach;
};

/// Samples at `from`, `from` + `every` and so on up to `until`; without `every` there are none.
struct Samples {
  std::optional<Decimal> every;
  Decimal from, until;
};

/// Averages over time in bins.
struct Averages : Samples {
  std::uint64_t bins = 0;
  std::vector<Decimal> range;  // {from, to}
};

/// What histograms count: collisions at `from` to `until`; gaps and clusters in samples.
struct Counting : Samples {
  std::optional<Decimal> cluster_gap;
  std::vector<Decimal> range;  // of the bins
};

/// Correlations of every `tag_every`-th particle.
struct Correlations : Samples {
  std::optional<Decimal> longest;  // time between the two states that are compared; none: all there is
  std::uint64_t tag_every = 0;
};

/// When the places of particles are measured: at times, and on the average over samples.
struct PlaceTimes : Samples {
  std::vector<Decimal> times;
  bool any() const { return !times.empty() || every; }
};

/// The structure factor at wave numbers 2 pi n/length.
struct Structure : PlaceTimes {
  std::uint64_t waves = 0;        // the largest n
  std::optional<Decimal> length;  // none: that of the system
};

/// Pairs of particles up to a distance.
struct Pairs : PlaceTimes {
  Decimal distance;
  std::uint64_t bins = 0;
};

struct Checkpoint {
  Decimal every_seconds;  // of computing time; 0: none during the run
};

/// The value of output.word that names no word.
inline constexpr std::string_view any_word = "any";

/// All lists of times are increasing and without repetition, within [run.start, run.until].
struct Output {
  Series series;
  std::vector<Decimal> snapshots;
  Profiles profiles;
  std::vector<Decimal> masses;  // times at which the distribution of masses is written
  Zone zone;
  Averages averages;
  std::vector<std::string> histograms;  // their names
  Counting counting;
  Correlations correlations;
  Structure structure;
  Pairs pair_distribution;
  bool scenario = false;  // wet rows: whether to decide between the two scenarios of Fig. 9
  bool core = false;      // of a shock: mass, width, velocities and gaps beside the series
  bool events = false;
  std::optional<std::string> word;  // the collisions of a few particles as letters, compared with this word
  bool every_replica = false;       // ensembles: whether the snapshots and profiles of every replica are kept
  Checkpoint checkpoint;

  bool has_histogram(std::string_view name) const;
  /// Whether a histogram is of the state at times: of gaps or of clusters.
  bool has_histogram_of_states() const { return has_histogram("gap") || has_histogram("cluster"); }
  bool observes_collisions() const;
};

/// What `cradle sweep` varies, unless the command line says otherwise.
struct Sweep {
  std::vector<std::string> vary;    // KEY=FROM:TO:COUNT[:log] or KEY=VALUE,VALUE,...
  bool cuts = false;                // one key at a time, the others as in the scene, instead of all combinations
  std::vector<std::string> points;  // or points one by one: KEY=VALUE KEY=VALUE ...
  std::uint64_t replicas = 0;       // of each point
};

struct Scene {
  std::string name;  // stem of the file, or the bundled scene's name
  std::string title;
  scene::Law law;
  Initial initial;
  WallPair walls;
  GravityOf gravity;
  Run run;
  Output output;
  Sweep sweep;
  std::map<std::string, Place, std::less<>> places;  // of the keys that its text gives
  std::string remarks;                               // lines for the user: what the scene says, but may not mean

  /// Where a key stands, or a table begins; without a line if the text has neither.
  Place place(std::string_view key) const;
  /// Of a list on a line: between particles, and to walls.
  std::size_t gaps() const {
    return initial.x.size() - 1 + walls.left.position.has_value() + walls.right.position.has_value();
  }
};

/// Whether masses differ or are not 1: formulas for particles of mass 1 do not apply then.
bool unequal_masses(const Scene& scene);

/// The longest lag of the correlations, in samples.
std::uint64_t longest_lag(const Scene& scene);

/// Whether the scenes have equal values of all keys, wherever they were read from.
bool operator==(const Scene& a, const Scene& b);

/// The whole scene with every default and the listed particles, without keys that cannot change a result. Equal scenes
/// give the same text; reading the text gives an equal scene, on any machine.
std::string effective_toml(const Scene& scene);

/// Keys and values (TOML syntax) that apply to this scene, in the table's order: those that differ from their defaults,
/// or all. Keys that cannot change a result are left out.
std::vector<std::pair<std::string, std::string>> values(const Scene& scene, bool all);

/// A value for display: long lists of numbers are shortened to their ends.
std::string shortened(const std::string& value);

/// The wall on which a single particle collapses, "walls.left" or "walls.right", which a rest speed of it would end;
/// empty if there is none.
std::string collapsing_floor(const Scene& scene);

/// The two ends of where all particles are, if the scene says it: a ring, or walls at rest.
std::optional<std::pair<Decimal, Decimal>> extent(const Scene& scene);

/// The first key in which two scenes differ, with both values; empty if there is none.
std::string scene_difference(const Scene& found, const Scene& wanted);

/// A file that the program carries, by embed.cmake.
struct EmbeddedFile {
  std::string_view name, text;
};

/// The files of tools/scenes, sorted by name.
std::span<const EmbeddedFile> bundled_scenes();

}  // namespace cradle::tools
