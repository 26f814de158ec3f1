// The table of keys. To add a key, add a member in scene.hpp or choices.hpp, and a row here.
#include "cradle/tools/scene/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <utility>

#include "cradle/tools/scene/checks.hpp"

namespace cradle::tools {
namespace {

// The member that these pointers to members lead to, one after the other.
template <auto... Path> constexpr auto member = +[](Scene& scene) -> auto& { return (scene.*....*Path); };

// The text, for as long as the program lives, since rows only refer to their texts.
std::string_view kept(std::string text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(text));
}

constexpr Condition always{"", "", "", [](const Scene&) { return true; }};

template <LawType Of> constexpr auto of_law = +[](const Scene& s) { return s.law.type == Of; };
template <InitialType Of> constexpr auto begins_as = +[](const Scene& s) { return s.initial.type == Of; };
template <scene::CollapsePolicy P> constexpr auto at_collapse = +[](const Scene& s) { return s.run.collapse == P; };

constexpr std::string_view other_law = "key of another law";
constexpr Condition inelastic{other_law, "law.type", "law.type = \"inelastic\"", of_law<LawType::inelastic>};
constexpr Condition wet{other_law, "law.type", "law.type = \"wet\"", of_law<LawType::wet>};
// `law.type = "wet" or "sticky"`: the key, and the names of the rows in which this member has this value.
template <class Row>
std::string_view those_that(std::string_view key, const auto& rows, bool Row::*member, bool value = true) {
  std::vector<std::string> names;
  for (const Row& row : rows)
    if (row.*member == value) names.push_back(fmt::format("\"{}\"", row.name));
  const std::string last = names.back();
  names.pop_back();
  return kept(fmt::format("{} = {}{}{}", key, fmt::join(names, ", "), names.empty() ? "" : " or ", last));
}
const std::string_view that_bounce = those_that("law.type", law_rows, &LawRow::merges, false);
const Condition merging{other_law, "law.type", those_that("law.type", law_rows, &LawRow::merges),
                        [](const Scene& s) { return law_row(s).merges; }};
constexpr Condition wet_shock{other_law, "law.type", "law.type = \"wet\" and equal rows", [](const Scene& s) {
                                return s.law.type == LawType::wet && s.initial.type == InitialType::rows &&
                                       !s.initial.general_rows();
                              }};

constexpr std::string_view other_state = "key of another initial state";
constexpr Condition plain_rows{
    other_state, "initial.left.particles", "initial.type = \"rows\" without [initial.left] and [initial.right]",
    [](const Scene& s) { return s.initial.type == InitialType::rows && !s.initial.general_rows(); }};
constexpr Condition general_rows{
    other_state, "initial.type", "initial.type = \"rows\" with [initial.left] and [initial.right]",
    [](const Scene& s) { return s.initial.type == InitialType::rows && s.initial.general_rows(); }};
template <bool InitialRow::*Member> Condition state_that_is() {
  return {other_state, "initial.type", those_that("initial.type", initial_rows, Member),
          [](const Scene& s) { return initial_row(s).*Member; }};
}
const Condition in_order = state_that_is<&InitialRow::in_order>(), on_line = state_that_is<&InitialRow::on_line>(),
                thermal_gas = state_that_is<&InitialRow::thermal>();
constexpr Condition on_lattice{
    other_state, "initial.positions", "initial.positions = \"lattice\" on rows, a ring, in a cold gas or a gas",
    [](const Scene& s) { return initial_row(s).in_order && s.initial.positions == Positions::lattice; }};
constexpr Condition gas{other_state, "initial.type", "initial.type = \"gas\"", begins_as<InitialType::gas>};
constexpr Condition ring{other_state, "initial.type", "initial.type = \"ring\"", begins_as<InitialType::ring>};
constexpr Condition list{other_state, "initial.type", "initial.type = \"list\"", begins_as<InitialType::list>};
constexpr Condition clusters{other_state, "initial.type", "initial.type = \"clusters\"",
                             begins_as<InitialType::clusters>};
constexpr Condition cold{other_state, "initial.type", "initial.type = \"cold\"", begins_as<InitialType::cold>};
constexpr Condition one_hot{other_state, "initial.hot", "initial.type = \"cold\" with initial.hot = 1",
                            [](const Scene& s) { return s.initial.type == InitialType::cold && s.initial.hot == 1; }};
constexpr Condition several_hot{
    other_state, "initial.hot", "initial.type = \"cold\" with several hot particles",
    [](const Scene& s) { return s.initial.type == InitialType::cold && s.initial.hot > 1; }};

const Condition may_have_walls{other_law, "law.type", that_bounce,
                               [](const Scene& s) { return !law_row(s).merges && s.initial.type != InitialType::gas; }};
const Condition may_fall{other_law, "law.type", that_bounce, [](const Scene& s) { return !law_row(s).merges; }};

constexpr Condition mpfr{"key of another precision", "run.precision", "run.precision = \"mpfr\"",
                         [](const Scene& s) { return s.run.precision == Precision::mpfr; }};

constexpr std::string_view other_policy = "key of another collapse policy";
constexpr Condition contact_time{other_policy, "run.collapse", "run.collapse = \"contact-time\"",
                                 at_collapse<scene::CollapsePolicy::contact_time>};
constexpr Condition merge{other_policy, "run.collapse", "run.collapse = \"merge\"",
                          at_collapse<scene::CollapsePolicy::merge>};
constexpr Condition stop{other_policy, "run.collapse", "run.collapse = \"stop\"",
                         at_collapse<scene::CollapsePolicy::stop>};

constexpr std::string_view other_series = "second way to say when the series is sampled";
constexpr Condition not_every{other_series, "output.series.every", "a series without every",
                              [](const Scene& s) { return !s.output.series.every; }};
constexpr Condition by_points{other_series, "output.series.every", "a series without every and times",
                              [](const Scene& s) { return !s.output.series.every && s.output.series.times.empty(); }};

constexpr Condition averaged{"key of averages that are not requested", "output.averages.every", "output.averages.every",
                             [](const Scene& s) { return s.output.averages.every.has_value(); }};
constexpr std::string_view no_histogram = "key of histograms that are not requested";
constexpr Condition counted{no_histogram, "output.histograms", "output.histograms",
                            [](const Scene& s) { return !s.output.histograms.empty(); }};
constexpr Condition states_counted{no_histogram, "output.histograms", "\"gap\" or \"cluster\" in output.histograms",
                                   [](const Scene& s) { return s.output.has_histogram_of_states(); }};
constexpr Condition clusters_counted{no_histogram, "output.histograms", "\"cluster\" in output.histograms",
                                     [](const Scene& s) { return s.output.has_histogram("cluster"); }};

constexpr Condition correlated{"key of correlations that are not requested", "output.correlations.every",
                               "output.correlations.every",
                               [](const Scene& s) { return s.output.correlations.every.has_value(); }};
constexpr std::string_view no_structure = "key of structure factors that are not requested";
constexpr Condition structured{no_structure, "output.structure.every",
                               "output.structure.times or output.structure.every",
                               [](const Scene& s) { return s.output.structure.any(); }};
constexpr Condition structure_averaged{no_structure, "output.structure.every", "output.structure.every",
                                       [](const Scene& s) { return s.output.structure.every.has_value(); }};
constexpr std::string_view no_pairs = "key of pair distributions that are not requested";
constexpr Condition paired{no_pairs, "output.pair_distribution.every",
                           "output.pair_distribution.times or output.pair_distribution.every",
                           [](const Scene& s) { return s.output.pair_distribution.any(); }};
constexpr Condition pairs_averaged{no_pairs, "output.pair_distribution.every", "output.pair_distribution.every",
                                   [](const Scene& s) { return s.output.pair_distribution.every.has_value(); }};

std::string start_of_run(const Scene& s) { return s.run.start.text; }
std::string end_of_run(const Scene& s) { return s.run.until.text; }
// The two ends of where all particles are, if these are known.
std::string extent_of(const Scene& s) {
  const auto ends = extent(s);
  return ends ? "[" + ends->first.text + ", " + ends->second.text + "]" : "[]";
}

std::string particles_as_length(const Scene& s) { return std::to_string(s.initial.particles); }

// The left wall and the length of so many particles at their density, as a decimal: rounded if it has no end.
std::string end_of_gas(const Scene& s) {
  constexpr int digits = 40;
  const bin_float length =
      bin_float(static_cast<std::int64_t>(s.initial.particles)) / precise(s.initial.density.value_or(Decimal("1")));
  return (precise(s.walls.left.position.value_or(Decimal("0"))) + length).str(digits);
}

std::string hot_as_energy(const Scene& s) { return std::to_string(s.initial.hot); }

std::string collapse_by_cutoff(const Scene& s) { return s.law.cutoff > Decimal("0") ? "\"cutoff\"" : "\"stop\""; }

template <auto M> constexpr auto law_of = member<&Scene::law, M>;
template <auto... M> constexpr auto initial_of = member<&Scene::initial, M...>;
template <auto... M> constexpr auto walls_of = member<&Scene::walls, M...>;
template <auto M> constexpr auto run_of = member<&Scene::run, M>;
template <auto M> constexpr auto sweep_of = member<&Scene::sweep, M>;
template <auto... M> constexpr auto output_of = member<&Scene::output, M...>;

// The names of rows, as a choice.
std::string_view names_of(const auto& rows) {
  std::string names;
  for (const auto& row : rows) names.append(names.empty() ? "" : " | ").append(row.name);
  return kept(std::move(names));
}

constexpr std::string_view any = "(-inf, inf)";
constexpr std::string_view within_run = "[run.start, run.until]";

// The keys of one of the two walls. `of_gas`: the row of its position where it ends a gas.
template <WallAt WallPair::*Wall> std::vector<Field> wall_fields(std::string_view side, const Field& of_gas) {
  const auto text = [&](std::string_view with_side) { return kept(fmt::format(fmt::runtime(with_side), side)); };
  static const Condition there{"key of a wall that is not there", text("walls.{}.position"), text("a {} wall"),
                               [](const Scene& s) { return (s.walls.*Wall).position.has_value(); }};
  static const Condition reflects{
      "key of a wall that reflects", text("walls.{}.temperature"), text("a {} wall without temperature"),
      [](const Scene& s) { return (s.walls.*Wall).position && !(s.walls.*Wall).temperature; }};
  static const Condition shaken{"key of a wall that is shaken", text("walls.{}.motion"), text("a shaken {} wall"),
                                [](const Scene& s) { return (s.walls.*Wall).position && (s.walls.*Wall).shaken(); }};
  static const Condition holds{"key of a wall on which particles can rest", "gravity.acceleration",
                               text("a {} wall without temperature, shaken or with gravity"), [](const Scene& s) {
                                 const WallAt& wall = s.walls.*Wall;
                                 return wall.position && !wall.temperature && (wall.shaken() || s.gravity.acts());
                               }};
  return {
      {text("walls.{}.position"), walls_of<Wall, &WallAt::position>, "l", "", any, &may_have_walls,
       text("position of a wall at the {} end of the line, at run.start; without it, none. A wall is a particle of "
            "infinite mass")},
      of_gas,
      {text("walls.{}.speed"), walls_of<Wall, &WallAt::speed>, "l/t", "0", any, &there,
       text("constant velocity of the {} wall, positive to the right: a piston")},
      {text("walls.{}.temperature"), walls_of<Wall, &WallAt::temperature>, "m l^2/t^2", "", "(0, inf)", &there,
       text("particles leave the {} wall at speeds v, against it, of the density (m v/T) exp(-m v^2/2T); without it, "
            "it reflects them")},
      {text("walls.{}.restitution"), walls_of<Wall, &WallAt::restitution>, "", "1", "[0, 1]", &reflects,
       text("factor by which a collision with the {} wall reduces the closing speed; 1 is elastic")},
      {text("walls.{}.motion"), walls_of<Wall, &WallAt::motion>, "", "\"none\"", "none | sawtooth | parabola | sine",
       &there,
       text("how the {} wall is shaken about its place, beginning in the middle, towards the particles: at a constant "
            "speed, jumping back; in parabolic arcs; as a sine")},
      {text("walls.{}.amplitude"), walls_of<Wall, &WallAt::amplitude>, "l", "required", "(0, inf)", &shaken,
       "how far it is shaken from its place at most"},
      {text("walls.{}.frequency"), walls_of<Wall, &WallAt::frequency>, "1/t", "required", "(0, inf)", &shaken,
       "angular frequency: 2 pi over the period"},
      {text("walls.{}.phase"), walls_of<Wall, &WallAt::phase>, "", "0", any, &shaken, "angle at run.start"},
      {text("walls.{}.rest_speed"), walls_of<Wall, &WallAt::rest_speed>, "l/t", "", "(0, inf)", &holds,
       text("a particle that meets the {} wall, or others that rest on it, more slowly stays there for as long as the "
            "wall presses it; without it, none stays")},
  };
}

// key, member, unit, default, range, applies when, documentation
const std::vector<Field> fields_before_walls{
    {"title", member<&Scene::title>, "", "\"\"", "", &always, "what the scene shows; printed on pictures"},

    {"law.type", law_of<&scene::Law::type>, "", "required", names_of(law_rows), &always, "what happens at a collision"},
    {"law.restitution", law_of<&scene::Law::restitution>, "", "required", "[0, 1]", &inelastic,
     "factor by which a collision reduces the closing speed; 1 is elastic"},
    {"law.cutoff", law_of<&scene::Law::cutoff>, "l/t", "0", "[0, inf)", &inelastic,
     "closing speed below which collisions are elastic; 0: none, the plain law"},
    {"law.cutoff_exponent", law_of<&scene::Law::cutoff_exponent>, "", "", "(0, inf)", &inelastic,
     "how the cut-off sets in: the restitution at a closing speed w is r + (1 - r) exp(-(w/cutoff)^this); without it, "
     "at once"},
    {"law.loss", law_of<&scene::Law::loss>, "m l^2/t^2", "required", "[0, inf)", &wet,
     "energy E_loss that it takes to rupture a liquid bridge; pairs whose relative motion has less (m w^2/4 for two of "
     "mass m that close at w) merge; 0: all collisions are elastic"},

    {"initial.type", initial_of<&Initial::type>, "", "required", names_of(initial_rows), &always,
     "which particles there are at the start"},
    {"initial.left.particles", initial_of<&Initial::left, &scene::Row::particles>, "", "required", "[1, 1e15]",
     &general_rows, "particles of the left row"},
    {"initial.left.speed", initial_of<&Initial::left, &scene::Row::speed>, "l/t", "required", any, &general_rows,
     "velocity of the left row, positive to the right"},
    {"initial.left.density", initial_of<&Initial::left, &scene::Row::density>, "1/l", "1", "(0, inf)", &general_rows,
     "particles per length of the left row"},
    {"initial.right.particles", initial_of<&Initial::right, &scene::Row::particles>, "", "required", "[1, 1e15]",
     &general_rows, "particles of the right row"},
    {"initial.right.speed", initial_of<&Initial::right, &scene::Row::speed>, "l/t", "required", any, &general_rows,
     "velocity of the right row, positive to the right"},
    {"initial.right.density", initial_of<&Initial::right, &scene::Row::density>, "1/l", "1", "(0, inf)", &general_rows,
     "particles per length of the right row"},
    {"initial.centre.mass", initial_of<&Initial::centre, &Centre::mass>, "m", "0", "[0, inf)", &general_rows,
     "mass of a particle at x = 0 between the rows; 0: none"},
    {"initial.centre.speed", initial_of<&Initial::centre, &Centre::speed>, "l/t", "0", any, &general_rows,
     "velocity of the particle between the rows"},
    {"initial.particles", initial_of<&Initial::particles>, "", "8000", "[2, 1e15] even", &plain_rows,
     "particles of both rows together; the first ones start at plus and minus half the spacing"},
    {"initial.particles", initial_of<&Initial::particles>, "", "8000", "[1, 1e15]", &ring, "particles on the ring"},
    {"initial.particles", initial_of<&Initial::particles>, "", "8000", "[2, 1e15]", &cold,
     "particles of the gas, those that move included"},
    {"initial.particles", initial_of<&Initial::particles>, "", "8000", "[1, 2147483647]", &gas,
     "particles between the two walls"},
    {"initial.density", initial_of<&Initial::density>, "1/l", "", "(0, inf)", &gas,
     "particles per length, 1 if nothing says it: gives walls.right.position, from that of the left wall on"},
    {"initial.hot", initial_of<&Initial::hot>, "", "1", "[1, initial.particles]", &cold,
     "how many particles move at the start, one beside the other; the others are at rest"},
    {"initial.place", initial_of<&Initial::place>, "", "\"middle\"", "middle | left", &cold,
     "where the hot particles are: in the middle of the others, about x = 0, or at the left end, from x = 0 on"},
    {"initial.speed", initial_of<&Initial::speed>, "l/t", "1", "(0, inf)", &one_hot,
     "velocity of the one hot particle, to the right"},
    {"initial.energy", initial_of<&Initial::energy>, "m l^2/t^2", "initial.hot", "(0, inf)", &several_hot,
     "energy of several hot particles together: Gaussian velocities without total momentum", hot_as_energy},
    {"initial.spacing", initial_of<&Initial::spacing>, "l", "1", "(0, inf)", &cold, "distance between neighbours"},
    {"initial.density_exponent", initial_of<&Initial::density_exponent>, "", "0", "(-inf, 1)", &cold,
     "how the density falls with the distance from x = 0: it is (1/l) (|x|/l)^-this, l being the spacing"},
    {"initial.speed", initial_of<&Initial::speed>, "l/t", "0.5", "(0, inf)", &plain_rows,
     "u0: the left row moves at +u0, the right one at -u0"},
    {"initial.spacing", initial_of<&Initial::spacing>, "l", "1", "(0, inf)", &plain_rows,
     "distance between neighbours in a row"},
    {"initial.positions", initial_of<&Initial::positions>, "", "\"lattice\"", "lattice | poisson", &in_order,
     "at equal distances, or those of a Poisson process: independent exponential gaps of mean one spacing; where the "
     "length is given, independent uniform positions"},
    {"initial.perturbation", initial_of<&Initial::perturbation>, "", "0", "[0, 0.5)", &on_lattice,
     "each particle is shifted uniformly by up to plus or minus this times the spacing"},
    {"initial.masses", initial_of<&Initial::masses>, "m", "", "(0, inf)", &in_order,
     "masses of the particles, repeated from the first one on, 1 where not given; on a ring a whole number of times"},
    {"initial.random_masses", initial_of<&Initial::random_masses>, "m", "", "(0, inf)", &in_order,
     "two masses, the smaller one first: each particle has one drawn uniformly between them; instead of "
     "initial.masses"},
    {"initial.length", initial_of<&Initial::length>, "l", "initial.particles", "(0, inf)", &ring,
     "circumference of the ring; positions on it are from 0 to below this", particles_as_length},
    {"initial.velocities", initial_of<&Initial::velocities>, "", "\"gaussian\"", "gaussian | uniform", &thermal_gas,
     "distribution of the velocities"},
    {"initial.variance", initial_of<&Initial::variance>, "l^2/t^2", "1", "(0, inf)", &thermal_gas,
     "variance of the velocities, one for all masses: of equal masses the temperature is mass times variance, and a "
     "mixture starts out of equilibrium"},
    {"initial.file", initial_of<&Initial::file>, "", "", "", &list,
     "CSV file of the particles, relative to the scene: a line x,v, x,v,m or gap,v (manual: Scene files), then "
     "decimals; or a result, the last snapshot of which is taken if it has all particles; results hold the particles "
     "themselves"},
    {"initial.x", initial_of<&Initial::x>, "l", "", any, &list, "positions, increasing; instead of a file"},
    {"initial.gap", initial_of<&Initial::gap>, "l", "", "[0, inf)", &list,
     "distances to the next particle, of any size, of all particles but the last; instead of initial.x, or beside the "
     "first particle's x, which is 0 by default. Results hold the positions, with all their digits"},
    {"initial.word", initial_of<&Initial::file>, "", "", "", &list,
     "a word of collisions, letters are gaps from the left: the particles start on its self-similar state (`cradle "
     "words`), at distances that add up to 1; instead of x and v"},
    {"initial.length", initial_of<&Initial::length>, "l", "0", "[0, inf)", &list,
     "circumference of the ring on which the particles are; 0: on a line"},
    {"initial.v", initial_of<&Initial::v>, "l/t", "", any, &list, "velocities; instead of a file"},
    {"initial.m", initial_of<&Initial::m>, "m", "", "(0, inf)", &list, "masses, 1 where not given; instead of a file"},
    {"initial.speed", initial_of<&Initial::speed>, "l/t", "0.5", "(0, inf)", &clusters,
     "u0: speed of the rows that come in from both sides"},
    {"initial.spacing", initial_of<&Initial::spacing>, "l", "1", "(0, inf)", &clusters,
     "distance between neighbours in the rows that come in"},
    {"initial.x", initial_of<&Initial::x>, "l", "required", any, &clusters,
     "positions of the two clusters, the left one first"},
    {"initial.v", initial_of<&Initial::v>, "l/t", "[0, 0]", any, &clusters, "velocities of the two clusters"},
    {"initial.growth", initial_of<&Initial::growth>, "", "[0.5, 0.5]", "[0, 1]", &clusters,
     "share of the incoming mass that each cluster takes up: its mass is 1 + 2 share u0 t / l"},
    {"initial.meeting", initial_of<&Initial::meeting>, "", "\"energy\"", "energy | pass | stick", &clusters,
     "what two clusters do when they meet: pass or stick by the wet law (energy), always pass, or always stick"},
    {"initial.seed", initial_of<&Initial::seed>, "", "1", "[0, 18446744073709551615]", &always,
     "seed of all random numbers"},
    {"initial.replica", initial_of<&Initial::replica>, "", "0", "[0, 18446744073709551615]", &always,
     "number of the replica; each has its own random numbers"},

    {"gravity.acceleration", member<&Scene::gravity, &GravityOf::acceleration>, "l/t^2", "", any, &may_fall,
     "constant acceleration of all particles, positive to the right; walls do not fall. The one that particles fall "
     "towards is a floor. Collisions with walls slower than law.cutoff are elastic then; without it, no gravity"},
};

const std::vector<Field> fields_after_walls{
    {"run.start", run_of<&Run::start>, "t", "0", any, &always, "time at the initial state"},
    {"run.until", run_of<&Run::until>, "t", "required", "[run.start, inf)", &always, "time at which the run ends"},
    {"run.precision", run_of<&Run::precision>, "", "\"double\"", names_of(scalar_rows), &always,
     "the working precision"},
    {"run.digits", run_of<&Run::digits>, "", "50", "[10, 1000]", &mpfr, "decimal digits of mpfr numbers"},
    {"run.coordinates", run_of<&Run::coordinates>, "", "\"gaps\"", "gaps | absolute", &always,
     "gaps and closing speeds, or plain positions"},
    {"run.collapse", run_of<&Run::collapse>, "", "cutoff with a law.cutoff, else stop",
     "cutoff | contact-time | merge | stop", &always, "what to do at inelastic collapse", collapse_by_cutoff},
    {"run.contact_time", run_of<&Run::contact_time>, "t", "required", "(0, inf)", &contact_time,
     "collisions are elastic if one of the two particles had another collision less than this time before"},
    {"run.merge_speed", run_of<&Run::merge_speed>, "l/t", "required", "(0, inf)", &merge,
     "particles that close slower than this stick"},
    {"run.stop_gap", run_of<&Run::stop_gap>, "l", "", "(0, inf)", &stop,
     "the run ends when a gap, or the height of a rebound from a floor, is below this, proved to collapse or not. "
     "Without it the run ends when a collapse is proved and its time is settled; with more than 16 particles in gaps, "
     "without gravity or shaken walls, also when a gap is below 2^-100 of one beside it at the start, without proof. "
     "A collapse of 4 to 16 particles then ends it only when the type resolves no more, which in mpfr and "
     "cpp_bin_float does not come in practice"},

    {"output.series.every", output_of<&Output::series, &Series::every>, "t", "", "(0, inf)", &always,
     "time between samples of the series, at most 1e7 of them"},
    {"output.series.times", output_of<&Output::series, &Series::times>, "t", "", within_run, &not_every,
     "times of the samples of the series"},
    {"output.series.points", output_of<&Output::series, &Series::points>, "", "1000", "[2, 1e7]", &by_points,
     "number of samples of the series, from run.start to run.until, both included"},
    {"output.series.over", output_of<&Output::series, &Series::over>, "t", "", "(run.start, run.until]", &by_points,
     "the points are spread over the time up to here, and continue with the same spacing; without it, up to run.until. "
     "`cradle resume --until` writes it"},
    {"output.series.spacing", output_of<&Output::series, &Series::spacing>, "", "\"linear\"", "linear | log",
     &by_points,
     "log: evenly in the logarithm of the time since run.start, from a millionth of the run on, after a first sample "
     "at run.start"},
    {"output.snapshots", output_of<&Output::snapshots>, "t", "[]", within_run, &always,
     "times at which all active particles are written"},
    {"output.profiles.times", output_of<&Output::profiles, &Profiles::times>, "t", "[]", within_run, &always,
     "times at which profiles, averages over bins, are written"},
    {"output.profiles.bins", output_of<&Output::profiles, &Profiles::bins>, "", "50", "[1, 1e6]", &always,
     "number of bins of the profiles"},
    {"output.profiles.range", output_of<&Output::profiles, &Profiles::range>, "l", "", any, &always,
     "the two ends of the bins; without it, those of the ring, or of the interaction zone at that time (ensembles need "
     "it). Bins beyond a ring have the images of its particles; on a line the last bin has its right end too"},
    {"output.masses", output_of<&Output::masses>, "t", "[]", within_run, &merging,
     "times at which the distribution of cluster masses is written"},
    {"output.zone.from", output_of<&Output::zone, &Zone::from>, "t", "", within_run, &wet_shock,
     "start of the average over the interaction zone, which also gives its width; without it, none"},
    {"output.zone.samples", output_of<&Output::zone, &Zone::samples>, "", "400", "[16, 1e7]", &wet_shock,
     "number of samples in the average over the zone, evenly spaced from output.zone.from on, the last an interval "
     "before run.until"},
    {"output.zone.bins", output_of<&Output::zone, &Zone::bins>, "", "60", "[4, 1e6]", &wet_shock,
     "number of bins of the average over the zone"},
    {"output.zone.reach", output_of<&Output::zone, &Zone::reach>, "l", "", "(0, inf)", &wet_shock,
     "the bins reach this far to either side; without it, three times the L of equation (13)"},
    {"output.scenario", output_of<&Output::scenario>, "", "false", "", &wet_shock,
     "watch whether the two heaviest clusters pass or stick; needs a series with spacing = \"log\" and 100 points a "
     "decade"},
    {"output.averages.every", output_of<&Output::averages, &Averages::every>, "t", "", "(0, inf)", &always,
     "time between the samples of averages over time, 32 samples at least; without it, none are made"},
    {"output.averages.from", output_of<&Output::averages, &Averages::from>, "t", "run.start", within_run, &averaged,
     "time of the first sample of the averages", start_of_run},
    {"output.averages.until", output_of<&Output::averages, &Averages::until>, "t", "run.until",
     "[output.averages.from, run.until]", &averaged, "no sample of the averages is later", end_of_run},
    {"output.averages.bins", output_of<&Output::averages, &Averages::bins>, "", "50", "[1, 1e5]", &averaged,
     "number of bins of the averages"},
    {"output.averages.range", output_of<&Output::averages, &Averages::range>, "l", "the ring, or between walls at rest",
     any, &averaged, "the two ends of the bins; beyond a ring they have the images of its particles", extent_of},
    {"output.histograms", output_of<&Output::histograms>, "", "",
     "free_flight | pair_flight | closing_speed | dissipative_closing_speed | collisions_per_particle | gap | cluster",
     &always, "what is counted in bins that are nearly logarithmic"},
    {"output.counting.from", output_of<&Output::counting, &Counting::from>, "t", "run.start", within_run, &counted,
     "histograms count collisions from here on; gaps and clusters here for the first time", start_of_run},
    {"output.counting.until", output_of<&Output::counting, &Counting::until>, "t", "run.until",
     "[output.counting.from, run.until]", &counted, "histograms count up to here", end_of_run},
    {"output.counting.every", output_of<&Output::counting, &Counting::every>, "t", "required", "(0, inf)",
     &states_counted, "time between counts of gaps and clusters"},
    {"output.counting.cluster_gap", output_of<&Output::counting, &Counting::cluster_gap>, "l", "required", "(0, inf)",
     &clusters_counted, "neighbours with a gap below this belong to one cluster"},
    {"output.counting.range", output_of<&Output::counting, &Counting::range>, "", "[1e-12, 1e6]", "(0, inf)", &counted,
     "numbers between these two have bins, eight in every octave; one bin each is for those below and above"},
    {"output.correlations.every", output_of<&Output::correlations, &Correlations::every>, "t", "", "(0, inf)", &always,
     "time between samples of tagged particles, and the shortest lag of their mean-square displacement and velocity "
     "autocorrelation; without it, none are made"},
    {"output.correlations.from", output_of<&Output::correlations, &Correlations::from>, "t", "run.start", within_run,
     &correlated, "time of the first sample of the correlations", start_of_run},
    {"output.correlations.until", output_of<&Output::correlations, &Correlations::until>, "t", "run.until",
     "[output.correlations.from, run.until]", &correlated, "no sample of the correlations is later", end_of_run},
    {"output.correlations.longest", output_of<&Output::correlations, &Correlations::longest>, "t", "",
     "[output.correlations.every, inf)", &correlated,
     "no lag is longer; without it, lags reach from the first sample to the last one"},
    {"output.correlations.tag_every", output_of<&Output::correlations, &Correlations::tag_every>, "", "1", "[1, 1e15]",
     &correlated, "every so many particles, from the left, one is tagged"},
    {"output.structure.times", output_of<&Output::structure, &Structure::times>, "t", "", within_run, &always,
     "times at which the structure factor is written"},
    {"output.structure.every", output_of<&Output::structure, &Structure::every>, "t", "", "(0, inf)", &always,
     "time between samples of the average structure factor; without it, no average is made"},
    {"output.structure.from", output_of<&Output::structure, &Structure::from>, "t", "run.start", within_run,
     &structure_averaged, "time of the first sample of the average", start_of_run},
    {"output.structure.until", output_of<&Output::structure, &Structure::until>, "t", "run.until",
     "[output.structure.from, run.until]", &structure_averaged, "no sample of the average is later", end_of_run},
    {"output.structure.waves", output_of<&Output::structure, &Structure::waves>, "", "1000", "[1, 1e9]", &structured,
     "largest n of the wave numbers 2 pi n/length; beyond 8 there are eight in every octave"},
    {"output.structure.length", output_of<&Output::structure, &Structure::length>, "l", "", "(0, inf)", &structured,
     "length of the wave with n = 1, on a ring a whole part of its length; without it, that of the ring, or between "
     "walls at rest"},
    {"output.pair_distribution.times", output_of<&Output::pair_distribution, &Pairs::times>, "t", "", within_run,
     &always, "times at which the pair distribution is written"},
    {"output.pair_distribution.every", output_of<&Output::pair_distribution, &Pairs::every>, "t", "", "(0, inf)",
     &always, "time between samples of the average pair distribution; without it, no average is made"},
    {"output.pair_distribution.from", output_of<&Output::pair_distribution, &Pairs::from>, "t", "run.start", within_run,
     &pairs_averaged, "time of the first sample of the average", start_of_run},
    {"output.pair_distribution.until", output_of<&Output::pair_distribution, &Pairs::until>, "t", "run.until",
     "[output.pair_distribution.from, run.until]", &pairs_averaged, "no sample of the average is later", end_of_run},
    {"output.pair_distribution.distance", output_of<&Output::pair_distribution, &Pairs::distance>, "l", "required",
     "(0, inf)", &paired, "pairs nearer than this are counted: half of a ring at most"},
    {"output.pair_distribution.bins", output_of<&Output::pair_distribution, &Pairs::bins>, "", "50", "[1, 1e5]",
     &paired, "number of bins of the pair distribution"},
    {"output.core", output_of<&Output::core>, "", "false", "", &on_line,
     "add to the series what the dense core of a shock is like, its mass, width, velocity range and median gap, and "
     "the energy beyond that of the sticky gas that began alike"},
    {"output.events", output_of<&Output::events>, "", "false", "", &always, "write every collision"},
    {"output.word", output_of<&Output::word>, "", "", "", &list,
     "write the order of the collisions compactly, as letters, which are gaps from the left, and say where it leaves "
     "this word; \"any\": of no word in particular. For up to 26 particles on a line that bounce"},
    {"output.every_replica", output_of<&Output::every_replica>, "", "false", "", &always,
     "in an ensemble, keep the snapshots and profiles of every replica beside the statistics"},
    {"output.checkpoint.every_seconds", output_of<&Output::checkpoint, &Checkpoint::every_seconds>, "", "60",
     "[0, inf)", &always,
     "seconds of computing between checkpoints, from which `cradle resume` continues, or ten times as long as the last "
     "one took to write if that is more; 0: only when the run ends or is interrupted. Never changes a result, and is "
     "not written into it",
     nullptr, false},

    {"sweep.vary", sweep_of<&Sweep::vary>, "", "[]", "", &always,
     "keys and values that a sweep combines, one text each: KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log or "
     "KEY=VALUE,VALUE,..."},
    {"sweep.cuts", sweep_of<&Sweep::cuts>, "", "false", "", &always,
     "vary one key at a time and keep the others as in the scene, instead of all combinations"},
    {"sweep.points", sweep_of<&Sweep::points>, "", "[]", "", &always,
     "points of a sweep, one text each: KEY=VALUE KEY=VALUE ..."},
    {"sweep.replicas", sweep_of<&Sweep::replicas>, "", "1", "[1, 1e15]", &always, "replicas of every point of a sweep"},
};

std::vector<Field> joined() {
  std::vector<Field> all;
  for (const std::vector<Field>& some :
       {fields_before_walls,
        wall_fields<&WallPair::left>("left", {"walls.left.position", walls_of<&WallPair::left, &WallAt::position>, "l",
                                              "0", any, &gas, "where the gas begins: the left one of its two walls"}),
        wall_fields<&WallPair::right>("right", {"walls.right.position", walls_of<&WallPair::right, &WallAt::position>,
                                                "l", "initial.particles/initial.density on", any, &gas,
                                                "where the gas ends: the right one of its two walls", end_of_gas}),
        fields_after_walls})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}
const std::vector<Field> all_fields = joined();

}  // namespace

std::span<const Field> scene_fields() { return all_fields; }

const Field* find_field(std::string_view key, const Scene& scene) {
  const Field* found = nullptr;
  for (const Field& field : all_fields) {
    if (field.key != key) continue;
    if (field.when->holds(scene)) return &field;
    if (found == nullptr) found = &field;
  }
  return found;
}

}  // namespace cradle::tools
