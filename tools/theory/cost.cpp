
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <vector>

#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/observe/correlations.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/core/theory/free_cooling.hpp"
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

// An upper bound for the particles of a cold gas that are reached: no particle is faster than one with all the energy.
double reached_when_cold(const Scene& scene) {
  const Initial& initial = scene.initial;
  double least = initial.masses.empty() ? 1 : initial.masses.front().value, heaviest = least;
  for (const Decimal& mass : initial.masses)
    least = std::min(least, mass.value), heaviest = std::max(heaviest, mass.value);
  if (!initial.random_masses.empty())
    least = initial.random_masses.front().value, heaviest = initial.random_masses.back().value;
  const auto hot = static_cast<double>(initial.hot);
  const double speed = initial.speed.value;
  const double energy = initial.hot > 1 ? initial.energy.value : heaviest * speed * speed / 2;
  const double even = std::sqrt(2 * energy / least) * span(scene) / initial.spacing.value;
  const double share = 1 - initial.density_exponent.value, layers = std::pow(even, share) / share;
  return std::min(static_cast<double>(initial.particles), hot + 2 * layers);
}

// The number of particles of two rows that have met the other row.
double reached(const Scene& scene) {
  return std::min(static_cast<double>(scene.initial.particles), layers(scene, span(scene)));
}

double particles_at_end(const Scene& scene) {
  const Initial& initial = scene.initial;
  if (initial.type == InitialType::list) return static_cast<double>(initial.x.size());
  if (initial.type == InitialType::cold && scene.run.coordinates == Coordinates::gaps) return reached_when_cold(scene);
  if (initial.general_rows()) return static_cast<double>(initial.left.particles + initial.right.particles);
  const bool streamed = initial.type == InitialType::rows && scene.run.coordinates == Coordinates::gaps;
  if (!streamed) return static_cast<double>(initial.particles);
  // Wet particles end in the clusters; 14 to 17 u0^2/E_loss of them have not arrived there in the scenes of Figs. 7 and
  // 11.
  const double speed = initial.speed.value;
  return scene.law.type == LawType::wet ? std::min(reached(scene), 20 * speed * speed / scene.law.loss.value)
                                        : reached(scene);
}

// A run of many particles that ends by itself although no collapse is proved.
bool ends_unproved(const Scene& scene) {
  const auto held = scene.initial.type == InitialType::list ? scene.initial.x.size() : scene.initial.particles;
  return !scene.run.stop_gap && scene.run.coordinates == Coordinates::gaps &&
         held > static_cast<std::uint64_t>(CollapseWatch<double>::few);
}

// A line, if a collapse does not end: in these types numbers hardly leave their range, and a cut-off of 0 ends none.
std::string endless_collapse(const Scene& scene, double particles) {
  const bool wide = scene.run.precision == Precision::mpfr || scene.run.precision == Precision::cpp_bin_float;
  const bool past = scene.run.collapse == scene::CollapsePolicy::cutoff && scene.law.cutoff.value == 0;
  const bool ends = !past && (scene.run.stop_gap || ends_unproved(scene) || !stops_at_collapse(scene));
  const auto onset = theory::collapse_onset_particles(scene.law.restitution.value);
  const bool collapses = unequal_masses(scene) || scene.walls.any() || particles >= onset.value_or(particles + 1);
  if (!wide || ends || scene.law.cutoff_exponent || !onset || !collapses || particles < (past ? 3 : 4)) return "";
  return fmt::format("in {} a run that comes to a collapse{} has no end: give {}\n",
                     scalar_row(scene.run.precision).name, past ? "" : " of more than three particles",
                     past ? "a law.cutoff, or run.collapse = \"stop\"" : "run.stop_gap");
}

// Gases of equal particles at rest on the whole, on a ring or between elastic or heated walls at rest.
void gas(const Scene& scene, Cost& cost) {
  const Initial& initial = scene.initial;
  const WallAt &left = scene.walls.left, &right = scene.walls.right;
  const auto ends = extent(scene);
  if (!ends || unequal_masses(scene) || scene.law.cutoff_exponent || scene.gravity.acts() || scene.walls.shaken() ||
      left.dissipates() || right.dissipates() || scene.law.type == LawType::wet)
    return;
  const double particles = static_cast<double>(initial.particles), length = ends->second.value - ends->first.value,
               time = span(scene);
  const bool walls = scene.walls.any();
  const theory::FreeCooling cooling{initial.variance.value, (particles - (walls ? 1 : 0)) / length};
  if (scene.law.type == LawType::sticky) {
    const double left_over = theory::sticky_clusters_per_particle(cooling, time);
    if (left_over < 0.5) cost.collisions = particles * (1 - left_over);
    return;
  }
  const double eps = scene.law.restitution.value, flights = cooling.density * std::sqrt(cooling.variance);
  if (walls && (left.temperature || right.temperature)) {
    const double s1 = std::sqrt((left.temperature ? left : right).temperature->value),
                 s2 = std::sqrt((right.temperature ? right : left).temperature->value);
    // Particles forget how they started within some passages.
    if (eps == 1 && time * std::min({s1, s2, std::sqrt(cooling.variance)}) > 10 * length)
      cost.collisions = theory::heated_collision_rate(particles, length, s1, s2) * time;
    return;
  }
  double until = time, elastic = 0;
  if (eps < 1) {
    // Once closing speeds, of variance 2 s^2, are below the cut-off, they stay as they are.
    const double tau = theory::haff_time(cooling, eps), slow = scene.law.cutoff.value / std::sqrt(2 * cooling.variance),
                 cooled = slow > 0 ? tau * std::max(0., 1 / slow - 1) : until,
                 clustering = theory::clustering_time(cooling, eps);
    const auto onset = theory::collapse_onset_particles(eps);
    if (cooled < std::min(until, clustering)) {
      until = cooled;
      elastic = std::min(1., slow) * (time - until);
    } else if (clustering < until && particles >= *onset) {
      until = clustering;
      cost.clustering = scene.run.start.value + clustering;
    }
  }
  // A particle between equal ones at distances l meets the first after l, not after l/2 on the average.
  const double before = initial.positions == Positions::lattice ? 0.25 : 0;
  const auto uniform = [&](double factor) { return initial.velocities == Velocities::uniform ? factor : 1; };
  double each =
      theory::haff_collisions_per_particle(cooling, eps, until) + flights * elastic * std::numbers::inv_sqrtpi;
  // Elastic particles keep their velocities: of uniform ones the mean |v - v'| is 2 s/sqrt(3), not 2 s/sqrt(pi).
  if (eps == 1) each *= uniform(std::sqrt(std::numbers::pi / 3));
  cost.collisions = std::max(0., (particles - (walls ? 0 : 1)) * each - particles * before);
  if (walls && eps == 1)  // mean |v|: s sqrt(2/pi), of uniform velocities s sqrt(3)/2
    *cost.collisions += particles / length * std::sqrt(cooling.variance) * time * std::numbers::sqrt2 *
                        std::numbers::inv_sqrtpi * uniform(std::sqrt(3 * std::numbers::pi / 8));
  // By this law a few particles cluster before most of them have collided; it does not count what follows.
  if (cost.clustering && *cost.collisions < particles) cost.collisions.reset();
}

// How a run ends at a collapse, and what takes it past.
std::string end_line(const Scene& scene) {
  if (particles_merge(scene)) return "";
  if (!stops_at_collapse(scene))
    return "to end sooner: run.collapse = \"stop\" without law.cutoff ends the run at the collapse; run.collapse = "
           "\"merge\" with a run.merge_speed and without law.cutoff, or a larger law.cutoff, takes fewer collisions "
           "past it\n";
  const std::string unproved =
      scene.run.stop_gap     ? fmt::format("a gap below run.stop_gap = {} does, too", scene.run.stop_gap->text)
      : ends_unproved(scene) ? "without proof, a gap below 2^-100 of one beside it at the start does, too"
                             : "another does where numbers leave their range (status 5), which may take long";
  return fmt::format(
      "a collapse that is proved ends the run (status 3); {}; to go past it: "
      "law.cutoff, or run.collapse = \"merge\" with a run.merge_speed\nif they collapse, more collisions "
      "follow, how many is not known beforehand\n",
      unproved);
}

// As to_be_watched (core/chains/masses.hpp) says of so many particles that two threads could share them.
bool watched_for_rounding(const Scene& scene, double particles) {
  std::vector<double> masses;
  for (const auto* some : {&scene.initial.masses, &scene.initial.random_masses})
    for (const Decimal& mass : *some) masses.push_back(mass.value);
  for (std::size_t i = 0; i < scene.initial.m.size(); ++i) masses.push_back(Decimal(scene.initial.m[i]).value);
  if (masses.empty()) return false;
  const auto [least, greatest] = std::ranges::minmax(masses);
  return least < greatest && (particles <= 1000 || 10000 * least < greatest);
}

}  // namespace

// Wet particles reached by the front lose their energy m u0^2/2: E_loss per collision, and half of that in the last one
// (3 collisions per particle at E_loss = 0.05, as counted in Fig. 11), but each sticks once.
void wet_rows(const Scene& scene, Cost& cost) {
  const double met = layers(scene, span(scene)), half = static_cast<double>(scene.initial.particles) / 2;
  const double energy = scene.initial.speed.value * scene.initial.speed.value / 2;
  cost.collisions = std::min(
      {met * (met + 1) / 2, half * half, reached(scene) * (std::max(energy / scene.law.loss.value, 0.5) + 0.5)});
}

// Each particle merges once.
void sticky_rows(const Scene& scene, Cost& cost) { cost.collisions = std::max(0.0, reached(scene) - 1); }

Cost expected_cost(const Scene& scene) {
  Cost cost;
  cost.particles = particles_at_end(scene);
  if (const auto of_rows = law_theory(scene).cost_of_rows; of_rows && equal_rows(scene)) of_rows(scene, cost);
  if (scene.initial.type == InitialType::ring || scene.initial.type == InitialType::gas) gas(scene, cost);
  const std::string floor = collapsing_floor(scene);
  cost.floor =
      !floor.empty() && !(floor == "walls.left" ? scene.walls.left : scene.walls.right).rest_speed && !cost.collisions;
  cost.endless = endless_collapse(scene, cost.particles);
  const ScalarRow& type = scalar_row(scene.run.precision);
  const std::uint64_t digits = scene.run.digits;
  const bool gaps = scene.run.coordinates == Coordinates::gaps;
  const bool in_steps = gaps && cost.particles >= 2 * gaps_per_thread &&
                        (type.type == Precision::double_ || type.type == Precision::double_double);
  const double one_by_one = 2e7 / (gaps ? type.gaps : type.absolute).at(digits);
  cost.collisions_per_second = in_steps ? 3 * one_by_one : one_by_one;
  // About 15 numbers per particle; a sample has nine columns of doubles and its time in the plan.
  constexpr double program = 20e6, numbers = 15, bytes_per_event = 48, bytes_per_sample = 80;
  const Series& series = scene.output.series;
  const double samples = series.every    ? span(scene) / series.every->value
                         : series.points ? static_cast<double>(*series.points)
                                         : static_cast<double>(series.times.size());
  cost.seconds_of_samples = 0.3 * samples * cost.particles / one_by_one;  // per particle, of the time of a collision
  const double bytes = type.bytes.at(digits);
  cost.memory = program + numbers * bytes * cost.particles + (bytes_per_sample + 2 * bytes) * samples;
  if (scene.output.events) cost.memory += bytes_per_event * cost.collisions.value_or(0);
  if (const Correlations& wanted = scene.output.correlations; wanted.every)
    cost.memory += Correlator::bytes(cost.particles / static_cast<double>(wanted.tag_every), longest_lag(scene));
  return cost;
}

std::string about(double x, int digits) {
  return fmt::format("{:g}", std::strtod(fmt::format("{:.{}g}", x, digits).c_str(), nullptr));
}

std::string expected_lines(const Scene& scene, const Cost& cost) {
  const bool loses = law_row(scene).merges || scene.law.restitution < Decimal("1");
  if (!cost.collisions) {
    const std::string floor = collapsing_floor(scene);
    const bool endless = (loses || !floor.empty()) && !particles_merge(scene) && !stops_at_collapse(scene);
    return fmt::format(
        "collisions and time: there is no estimate for this scene{}{}\n{}",
        endless ? "; where particles collapse they may be very many" : "",
        endless && cost.floor ? fmt::format(": with {}.rest_speed they come to rest there instead", floor) : "",
        cost.endless);
  }
  const auto* after = stops_at_collapse(scene) ? "where the run stops"
                      : particles_merge(scene) ? "after which particles merge"
                                               : "after which more follow, how many is not known";
  std::string text = fmt::format("collisions: about {}", about(*cost.collisions));
  if (cost.collapse)
    text += fmt::format(" until inelastic collapse at about t = {}, {}", about(*cost.collapse, 3), after);
  if (cost.clustering)
    text += fmt::format(" until particles cluster at about t = {}, by Haff's law; how many follow is not known{}",
                        about(*cost.clustering, 3), stops_at_collapse(scene) ? ", until clusters collapse" : "");
  return text + '\n' + (cost.collapse || cost.clustering ? end_line(scene) : "") + cost.endless;
}

std::string expected_warning(const Scene& scene) {
  const Cost cost = expected_cost(scene);
  const bool said = cost.collapse || cost.clustering || (cost.floor && !stops_at_collapse(scene));
  return said && !particles_merge(scene) ? expected_lines(scene, cost) : cost.endless;
}

Threading expected_threading(const Scene& scene, const Cost& cost, unsigned threads) {
  const auto alone = [](const char* why) { return Threading{1, why}; };
  const bool merge = particles_merge(scene);
  if (without_collisions(scene)) return alone("the sticky gas is computed without collisions");
  if (scene.run.coordinates != Coordinates::gaps) return alone("absolute coordinates");
  if (scene.run.collapse == scene::CollapsePolicy::contact_time) return alone("collisions with a memory");
  if (!merge && scene.run.collapse == scene::CollapsePolicy::stop && scene.law.restitution < Decimal("1"))
    return alone("run.collapse = \"stop\" watches every collision");
  if (scene.walls.left.rest_speed || scene.walls.right.rest_speed) return alone("particles that rest on a wall");
  // Two threads are 1.3 to 1.7 times as fast as one, bench/results/speed.md. One thread alone sorts and writes events:
  // then they are 1.0 to 1.6 times as fast.
  const double efficiency = scene.output.events ? 0.65 : 0.75;
  const double segments = std::min<double>(threads, std::floor(cost.particles / gaps_per_thread));
  if (segments < 2) return alone(threads < 2 ? "one thread" : "few particles");
  if (!merge && watched_for_rounding(scene, cost.particles))
    return alone("unequal masses of few particles, or far apart, are watched for rounding");
  return {efficiency * segments, ""};
}

}  // namespace cradle::tools
