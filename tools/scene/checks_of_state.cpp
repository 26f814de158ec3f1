// Particles and walls at the start. Each check is one function. All comparisons are exact, on the decimals.
#include "cradle/tools/scene/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <compare>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "cradle/core/theory/wet_zone.hpp"

namespace cradle::tools {
namespace {

// The outermost possible position of a particle on one side at the start. Nothing if it is known only after particles
// are set up.
std::optional<bin_float> outermost(const Checked& of, int side) {
  const Initial& initial = of.scene.initial;
  if (initial.type != InitialType::rows || initial.positions != Positions::lattice) return {};
  const scene::Row& row = side < 0 ? initial.left : initial.right;
  const bin_float spacing = initial.general_rows() ? bin_float(1) / precise(row.density) : precise(initial.spacing);
  const bin_float particles(static_cast<std::int64_t>(initial.general_rows() ? row.particles : initial.particles / 2));
  return bin_float(side) * (particles - bin_float(1) / bin_float(2) + precise(initial.perturbation)) * spacing;
}

void same_length(const Checked& of, std::string_view key, std::size_t length) {
  const std::size_t particles = of.scene.initial.x.size();
  if (length != particles)
    of.refuse(key, "not one per particle", fmt::format("{} for {} positions", length, particles),
              fmt::format("give {} numbers", particles));
}

void rows_meet(const Checked& of) {
  if (!of.scene.initial.general_rows()) return;
  const scene::Row& left = of.scene.initial.left;
  const scene::Row& right = of.scene.initial.right;
  const Centre& centre = of.scene.initial.centre;
  if (left.speed <= right.speed)
    of.refuse("initial.right.speed", "the rows do not meet",
              fmt::format("left row at {}, right row at {}", left.speed.text, right.speed.text),
              "give the right row a lower velocity than the left row");
  if (centre.mass == Decimal("0")) {
    if (of.entries.contains("initial.centre.speed") && !of.entries.contains("initial.centre.mass"))
      of.refuse("initial.centre.speed", "speed of a particle that is not there", "initial.centre.mass = 0",
                "give initial.centre.mass too, or remove this key");
    return;
  }
  if (centre.speed > left.speed || centre.speed < right.speed)
    of.refuse("initial.centre.speed", "a row does not reach the particle between the rows",
              fmt::format("left row at {}, centre at {}, right row at {}", left.speed.text, centre.speed.text,
                          right.speed.text),
              "give a velocity between those of the rows");
}

// A word says where its particles are and how they move.
void word_alone(const Checked& of) {
  for (const char* key : {"initial.x", "initial.gap", "initial.v", "initial.file"})
    if (of.entries.contains(key))
      of.refuse(key, "particles of a word and others", "initial.word too", "remove one of them");
  if (of.scene.law.type != LawType::inelastic)
    of.refuse("initial.word", "words are of particles that bounce", *of.scene.initial.file,
              "give law.type = \"inelastic\"");
  const auto wall_at = [&](const char* key, const WallAt& wall, const char* position) {
    if (!wall.position) return;
    if (*wall.position != Decimal(position) || wall.speed != Decimal("0") || wall.temperature || wall.shaken() ||
        wall.restitution != of.scene.law.restitution)
      of.refuse(key, "not a wall of a word", wall.position->text,
                std::string("give a wall at ") + position + ", at rest, with the restitution of the particles");
  };
  wall_at("walls.left.position", of.scene.walls.left, "0");
  wall_at("walls.right.position", of.scene.walls.right, "1");
}

void one_list_of_particles(const Checked& of) {
  const Initial& initial = of.scene.initial;
  if (initial.type != InitialType::list) return;
  if (of.entries.contains("initial.word")) return word_alone(of);
  const char* const given = of.entries.contains("initial.x") ? "initial.x" : "initial.gap";
  const bool inline_particles = !initial.x.empty() || of.entries.contains(given);
  if (initial.file && inline_particles)
    of.refuse("initial.file", "two lists of particles", std::string("initial.file and ") + given, "remove one of them");
  if (initial.file) {
    if (initial.file->empty())
      of.refuse("initial.file", "no file name", "an empty text", "name a CSV file of particles");
    for (const char* key : {"initial.v", "initial.m"})
      if (of.entries.contains(key))
        of.refuse(key, "two lists of particles", "initial.file too", "put it into the file, or remove the file");
    return;
  }
  if (!inline_particles)
    of.refuse("initial.file", "missing", "",
              "name a CSV file of particles, or give initial.x (or initial.gap) and initial.v");
  if (initial.x.empty()) of.refuse("initial.x", "no particles", "an empty list", "give at least one position");
  same_length(of, "initial.v", initial.v.size());
  if (of.entries.contains("initial.m")) same_length(of, "initial.m", initial.m.size());
  const bool gaps = of.entries.contains("initial.gap");
  check_order(initial.x, initial.v, of.scene.run, [&](std::size_t i) {
    return gaps ? of.item_place("initial.gap", i - 1) : of.item_place("initial.x", i);
  });
}

void two_clusters(const Checked& of) {
  const Initial& initial = of.scene.initial;
  if (initial.type != InitialType::clusters) return;
  if (of.scene.law.type != LawType::wet)
    of.refuse("initial.type", "clusters need the wet law", of.said("law.type"),
              "give law.type = \"wet\" or another initial state");
  for (const auto& [key, numbers] : {std::pair("initial.x", initial.x.size()), std::pair("initial.v", initial.v.size()),
                                     std::pair("initial.growth", initial.growth.size())})
    if (numbers != 2)
      of.refuse(key, "not one per cluster", fmt::format("{} for two clusters", numbers), "give two numbers");
  if (std::is_lteq(compare_decimals(initial.x[1], initial.x[0])))
    throw Error(of.item_place("initial.x", 1), "not increasing", fmt::format("{} after {}", initial.x[1], initial.x[0]),
                "give the left cluster first");
  if (of.scene.run.start < Decimal("0"))
    of.refuse("run.start", "before the clusters begin to grow", of.scene.run.start.text, "give 0 or more");
  if (const std::string without = without_zone(of.scene); !without.empty())
    of.refuse("law.loss", without, of.scene.law.loss.text, "give another loss or initial.speed");
  for (const Field& field : scene_fields()) {
    const std::string_view key = field.key;
    if (!key.starts_with("output.") || key.starts_with("output.series.") || key.starts_with("output.checkpoint.") ||
        key == "output.profiles.bins" || key == "output.profiles.range" || key == "output.every_replica")
      continue;
    if (!field.when->holds(of.scene)) continue;
    if (const auto text = value_text(field, of.scene); text && *text != "[]" && *text != "false")
      of.refuse(key, "nothing to write", "two clusters in the force of particles that are not there", "remove it");
  }
}

void walls_shake(const Checked& of) {
  for (const auto& [name, wall] :
       {std::pair("walls.left.", &of.scene.walls.left), std::pair("walls.right.", &of.scene.walls.right)}) {
    const double span = of.scene.run.until.value - of.scene.run.start.value;
    if (wall->shaken() && !(wall->frequency.value * span + std::abs(wall->phase.value) < 1e15))
      of.refuse(name + std::string("frequency"), "more periods than can be counted",
                fmt::format("frequency {}, phase {}, for a time of {:g}", wall->frequency.text, wall->phase.text, span),
                "give a smaller frequency or phase, or an earlier run.until");
    if (wall->rest_speed && of.scene.run.coordinates == Coordinates::absolute)
      of.refuse(name + std::string("rest_speed"), "a particle that rests, in absolute positions",
                wall->rest_speed->text, "give run.coordinates = \"gaps\"");
    if (wall->shaken() && !wall->temperature && wall->restitution == Decimal("0") && !wall->rest_speed)
      of.refuse(name + std::string("restitution"), "a shaken wall on which particles come to rest", "0",
                "give it a rest_speed, or a small restitution, 0.01 or so");
  }
}

// Several particles rest at one end only, and not between two shaken walls.
void particles_can_rest(const Checked& of) {
  const auto& [left, right] = of.scene.walls;
  if (!left.position || !right.position || !(left.rest_speed || right.rest_speed)) return;
  if (of.scene.initial.type == InitialType::list && of.scene.initial.x.size() < 2) return;
  if (left.rest_speed && right.rest_speed)
    of.refuse("walls.right.rest_speed", "two walls on which several particles can rest", right.rest_speed->text,
              "leave it out at one of them");
  if (left.shaken() && right.shaken())
    of.refuse(left.rest_speed ? "walls.left.rest_speed" : "walls.right.rest_speed",
              "several particles that rest between two shaken walls", "both walls have a motion",
              "leave out one motion, or the rest_speed");
}

// If particles are displaced at random, each replica is checked when it is set up (core/initial/walled.hpp).
void walls_stand(const Checked& of) {
  const auto& [left, right] = of.scene.walls;
  if (!of.scene.walls.any()) return;
  const std::string first = left.position ? "walls.left.position" : "walls.right.position";
  const Initial& initial = of.scene.initial;
  if (initial.on_ring() || initial.type == InitialType::clusters)
    of.refuse(first, "a wall without a line of particles", of.said("initial.type"),
              "remove [walls], or give particles on a line");
  if (of.scene.run.collapse == scene::CollapsePolicy::merge)
    of.refuse(first, "a wall for particles that merge", "run.collapse = \"merge\"",
              "remove [walls], or choose another collapse policy");
  const auto among = [&](const char* key, const Decimal& wall, const std::string& particle) {
    of.refuse(key, "a wall among the particles, which would have met before the start",
              fmt::format("wall at {}, {}", wall.text, particle), "move it outwards");
  };
  walls_shake(of);
  particles_can_rest(of);
  // Shaken walls are checked where they are at the start (core/initial/walled.hpp).
  const bool listed = initial.type == InitialType::list && !initial.x.empty();
  for (const auto& [key, wall, side, which] :
       {std::tuple("walls.left.position", &left, -1, "first"), std::tuple("walls.right.position", &right, 1, "last")}) {
    if (!wall->position || wall->shaken()) continue;
    if (listed) {
      const auto at = side < 0 ? initial.x[0] : initial.x.back();
      if (const auto order = compare_decimals(wall->position->text, at);
          side < 0 ? std::is_gteq(order) : std::is_lteq(order))
        among(key, *wall->position, fmt::format("{} particle at {}", which, at));
    } else if (const auto at = outermost(of, side); at && !(bin_float(side) * (precise(*wall->position) - *at) > 0)) {
      among(key, *wall->position, fmt::format("{} particle at {:g}", which, static_cast<double>(*at)));
    }
  }
  if (!left.position || !right.position) return;
  bin_float gap = precise(*right.position) - precise(*left.position);
  for (const WallAt* wall : {&left, &right})
    if (wall->shaken()) gap -= precise(wall->amplitude);
  if (!(gap > 0))
    of.refuse(left.shaken() ? "walls.left.amplitude" : "walls.right.amplitude", "walls that can meet",
              fmt::format("as near as {:g}", static_cast<double>(gap)),
              "give smaller amplitudes, or positions further apart");
  const bin_float closing = precise(left.speed) - precise(right.speed);
  const bin_float span = precise(of.scene.run.until) - precise(of.scene.run.start);
  if (gap - closing * span > 0) return;
  of.refuse(left.speed == Decimal("0") ? "walls.right.speed" : "walls.left.speed", "the walls meet before the run ends",
            fmt::format("at t = {:g}", static_cast<double>(precise(of.scene.run.start) + gap / closing)),
            "give smaller speeds, or an earlier run.until");
}

void particles_can_fall(const Checked& of) {
  if (!of.scene.gravity.acts()) return;
  const Initial& initial = of.scene.initial;
  const std::string& acceleration = of.scene.gravity.acceleration->text;
  if (initial.on_ring())
    of.refuse("gravity.acceleration", "gravity on a ring, which has no ends to fall to", acceleration,
              "remove [gravity], or give particles on a line");
  if (initial.type == InitialType::clusters)
    of.refuse("gravity.acceleration", "gravity on two clusters, which have a force of their own", acceleration,
              "remove [gravity], or give another initial state");
  if (of.scene.run.collapse == scene::CollapsePolicy::merge)
    of.refuse("gravity.acceleration", "gravity on particles that merge", "run.collapse = \"merge\"",
              "choose another collapse policy; below the rest_speed of a floor particles stay on it");
  const bool to_left = *of.scene.gravity.acceleration < Decimal("0");
  const WallAt& floor = to_left ? of.scene.walls.left : of.scene.walls.right;
  if (floor.position && !floor.temperature && floor.restitution == Decimal("0") && !floor.rest_speed)
    of.refuse(to_left ? "walls.left.restitution" : "walls.right.restitution", "a floor on which particles come to rest",
              "0", "give it a rest_speed, or a small restitution, 0.01 or so");
}

void gas_between_walls(const Checked& of) {
  const Initial& initial = of.scene.initial;
  if (initial.type != InitialType::gas) return;
  if (law_row(of.scene).merges)
    of.refuse("initial.type", "a gas between walls needs a law that bounces", of.said("law.type"),
              "give law.type = \"inelastic\" or another initial state");
  const Decimal &left = *of.scene.walls.left.position, &right = *of.scene.walls.right.position;
  if (right <= left)
    of.refuse("walls.right.position", "walls without room for a gas",
              fmt::format("from {} to {}", left.text, right.text), "give the left wall a lower position");
  Scene other = of.scene;
  store_default(*find_field("walls.right.position", of.scene), other);
  if (initial.density && *other.walls.right.position != right)
    of.refuse("initial.density", "a density and both walls",
              fmt::format("density {}, walls at {} and {}", initial.density->text, left.text, right.text),
              "remove initial.density or walls.right.position");
}

void random_masses(const Checked& of) {
  if (!of.entries.contains("initial.random_masses")) return;
  if (of.entries.contains("initial.masses"))
    of.refuse("initial.random_masses", "two ways to give masses", "initial.masses too", "remove one of them");
  of.rising("initial.random_masses", of.scene.initial.random_masses, "not a range of masses",
            "give two masses, the smaller one first");
}

void masses_fit(const Checked& of) {
  if (!unequal_masses(of.scene)) return;
  const std::string given = of.scene.initial.random_masses.empty() ? "initial.masses" : "initial.random_masses";
  if (of.scene.output.scenario || of.scene.output.zone.from)
    of.refuse(of.scene.output.scenario ? "output.scenario" : "output.zone.from", "for particles of mass 1",
              given + " of others", "remove one of the two");
}

void masses_repeat(const Checked& of) {
  const Initial& initial = of.scene.initial;
  masses_fit(of);
  if (!of.entries.contains("initial.masses")) return;
  const std::size_t period = initial.masses.size();
  if (period == 0) of.refuse("initial.masses", "no masses", "an empty list", "give at least one mass");
  if (initial.type == InitialType::ring && initial.particles % period != 0)
    of.refuse("initial.masses", "the pattern does not divide the ring",
              fmt::format("{} masses, {} particles", period, initial.particles),
              fmt::format("give initial.particles as a multiple of {}", period));
}

}  // namespace

std::string without_zone(const Scene& scene) try {
  theory::WetZone<double>({scene.law.loss.value, scene.initial.speed.value, scene.initial.spacing.value});
  return "";
} catch (const std::domain_error& error) {
  return error.what();
}

void check_state(const Checked& of) {
  for (const auto check : {rows_meet, one_list_of_particles, two_clusters, gas_between_walls, walls_stand,
                           particles_can_fall, random_masses, masses_repeat})
    check(of);
}

}  // namespace cradle::tools
