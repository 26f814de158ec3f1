// The engine's particles for a scene, with every number read in the working precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <string>

#include "cradle/core/initial/cold.hpp"
#include "cradle/core/initial/gas.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/poisson.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

template <Real T> T number(const Decimal& decimal) {
  if constexpr (std::same_as<T, double>)  // where it is one of its range, it is rounded already
    if (decimal.value != 0 && std::isfinite(decimal.value)) return decimal.value;
  return from_text<T>(decimal.text);
}

template <Real T> std::vector<T> numbers(const DecimalColumn& column) {
  std::vector<T> values;
  values.reserve(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) values.push_back(from_text<T>(column[i]));
  return values;
}

/// The exact differences of neighbours, right less left (sign 1) or left less right (-1), each rounded once.
template <Real T> std::vector<T> neighbour_differences(const DecimalColumn& column, int sign) {
  std::vector<T> values;
  values.reserve(column.size());
  for (std::size_t i = 1; i < column.size(); ++i)
    values.push_back(from_text<T>(difference(column[sign > 0 ? i : i - 1], column[sign > 0 ? i - 1 : i])));
  return values;
}

/// How many particles rows, a ring, a cold gas or a gas have.
inline ParticleIndex particles_in_order(const Initial& initial) {
  if (!initial.general_rows()) return static_cast<ParticleIndex>(initial.particles);
  return static_cast<ParticleIndex>(initial.left.particles + initial.right.particles) +
         (initial.centre.mass > Decimal("0") ? 1 : 0);
}

template <Real T> MassPattern<T> mass_pattern(const Initial& initial) {
  if (!initial.random_masses.empty())
    return MassPattern<T>(number<T>(initial.random_masses.front()), number<T>(initial.random_masses.back()),
                          particles_in_order(initial), initial.seed, initial.replica);
  std::vector<T> masses;
  bool identical = true;
  for (const Decimal& mass : initial.masses) {
    masses.push_back(number<T>(mass));
    identical = identical && mass == initial.masses.front();
  }
  return MassPattern<T>(std::move(masses), identical);
}

inline cradle::HotPlace hot_place(const Initial& initial) {
  return initial.place == scene::HotPlace::left ? cradle::HotPlace::left : cradle::HotPlace::middle;
}

/// Where particles are, as displacements from equal distances; null for a list.
inline Displacement displacement_of(const Initial& initial) {
  if (initial.type == InitialType::list) return {};
  if (initial.positions == Positions::lattice)
    // The nearest double may be 1/2; the perturbation is smaller.
    return uniform_displacement(std::min(initial.perturbation.value, std::nextafter(0.5, 0.)), initial.seed,
                                initial.replica);
  const ParticleIndex count = particles_in_order(initial);
  if (initial.type == InitialType::ring || initial.type == InitialType::gas)
    return uniform_places(count, initial.seed, initial.replica);
  const auto from = [&](ParticleIndex origin, bool at_origin, auto half_steps) {
    return poisson_displacement(count, origin, at_origin, half_steps, initial.seed, initial.replica);
  };
  if (initial.type == InitialType::cold) {
    // The hot particle that is the first one, or in the middle of them, is at x = 0.
    const auto hot = static_cast<ParticleIndex>(initial.hot);
    const bool left = initial.place == scene::HotPlace::left;
    const ParticleIndex first = first_hot(hot_place(initial), count, hot), origin = left ? 0 : first + (hot - 1) / 2;
    return from(origin, true, [=](ParticleIndex p) { return left ? 2 * p : 2 * (p - first) + 1 - hot; });
  }
  const bool general = initial.general_rows(), centre = general && initial.centre.mass > Decimal("0");
  const auto left = general ? static_cast<ParticleIndex>(initial.left.particles) : count / 2;
  return from(left, centre, [=](ParticleIndex p) {
    if (!centre || p < left) return 2 * (p - left) + 1;
    return p == left ? 0 : 2 * (p - left) - 1;
  });
}

/// The distance of the first or the last particle to the wall beside it, and its closing speed, from the scene's
/// decimals: a difference of rounded positions may have no correct digit. They are decimals, exact or with so many
/// digits that they are rounded to the same number in the working precision. Without a closing speed the particle's
/// velocity is no number of the scene.
struct AtWallText {
  std::string gap;
  std::optional<std::string> closing_speed;
};
/// Of the particle beside the wall at this end, if there is one; in its place if the wall is shaken. Only for lists,
/// rows and cold gases. `displacement` is that of the scene's particles (null for a list).
std::optional<AtWallText> at_wall(const Scene& scene, End end, const Displacement& displacement);

namespace detail {

template <Real T>
std::shared_ptr<const cradle::Particles<T>> particles_without_walls(const Initial& initial, const WallPair& walls,
                                                                    const Displacement& displacement) {
  if (initial.type == InitialType::list) {
    const DecimalColumn &x = initial.x, &v = initial.v;
    const auto momentum = sum_of_products(v, initial.m);
    std::vector<T> velocities = numbers<T>(v);
    Differences<T> between{neighbour_differences<T>(x, 1), neighbour_differences<T>(v, -1), {}};
    if (nearly_equal(velocities))
      for (std::size_t i = 0; i < v.size(); ++i) between.from_first.push_back(from_text<T>(difference(v[i], v[0])));
    if (initial.on_ring()) {
      between.gaps.push_back(from_text<T>(difference(initial.length.text, difference(x.back(), x[0]))));
      between.closing_speeds.push_back(from_text<T>(difference(v.back(), v[0])));
    }
    return std::make_shared<List<T>>(
        numbers<T>(x), std::move(velocities), numbers<T>(initial.m), number<T>(initial.length),
        momentum ? std::optional<T>(from_text<T>(*momentum)) : std::nullopt, std::move(between));
  }
  if (initial.type == InitialType::cold) {
    const auto all = static_cast<ParticleIndex>(initial.particles), hot = static_cast<ParticleIndex>(initial.hot);
    const ParticleIndex first = first_hot(hot_place(initial), all, hot);
    MassPattern<T> masses = mass_pattern<T>(initial);
    HotParticles<T> moving = hot == 1
                                 ? kicked(first, number<T>(initial.speed))
                                 : heated(first, hot, number<T>(initial.energy), masses, initial.seed, initial.replica);
    return std::make_shared<Cold<T>>(all, number<T>(initial.spacing), hot_place(initial), std::move(moving),
                                     displacement, std::move(masses), initial.density_exponent.value);
  }
  if (initial.type == InitialType::ring || initial.type == InitialType::gas) {
    using std::sqrt;
    const auto count = static_cast<ParticleIndex>(initial.particles);
    const T deviation = sqrt(number<T>(initial.variance));
    const VelocityDraw draw = initial.velocities == Velocities::gaussian
                                  ? gaussian_velocity(initial.seed, initial.replica)
                                  : uniform_velocity(initial.seed, initial.replica);
    if (initial.type == InitialType::ring)
      return std::make_shared<Ring<T>>(count, number<T>(initial.length), deviation, draw, displacement,
                                       mass_pattern<T>(initial));
    const Decimal &left = *walls.left.position, &right = *walls.right.position;
    return std::make_shared<Gas<T>>(count, number<T>(left), from_text<T>(difference(right.text, left.text)), deviation,
                                    draw, displacement, mass_pattern<T>(initial));
  }
  if (!initial.general_rows())
    return std::make_shared<Rows<T>>(symmetric_rows<T>(static_cast<ParticleIndex>(initial.particles),
                                                       number<T>(initial.speed), number<T>(initial.spacing),
                                                       displacement, mass_pattern<T>(initial)));
  const auto row = [](const scene::Row& r) {
    return cradle::Row<T>{static_cast<ParticleIndex>(r.particles), number<T>(r.speed), T(1) / number<T>(r.density)};
  };
  std::optional<CentralParticle<T>> centre;
  if (initial.centre.mass > Decimal("0"))
    centre = CentralParticle<T>{number<T>(initial.centre.mass), number<T>(initial.centre.speed)};
  const auto &left = initial.left.speed, &right = initial.right.speed, &between = centre ? initial.centre.speed : right;
  std::optional<RowSpeeds<T>> differences;
  if (nearly_equal<T>({number<T>(left), number<T>(between), number<T>(right)})) {
    const auto from_left = [&](const Decimal& v) { return from_text<T>(difference(v.text, left.text)); };
    differences = {T(0), from_left(between), from_left(right)};
  }
  return std::make_shared<Rows<T>>(row(initial.left), row(initial.right), centre, displacement,
                                   mass_pattern<T>(initial), differences);
}

inline Shape shape_of(scene::Motion motion) {
  switch (motion) {
  case scene::Motion::sawtooth:
    return Shape::sawtooth;
  case scene::Motion::parabola:
    return Shape::parabola;
  case scene::Motion::sine:
  case scene::Motion::none:
    break;
  }
  return Shape::sine;
}

template <Real T> std::optional<Wall<T>> wall_of(const WallAt& wall, const Initial& initial) {
  if (!wall.position) return {};
  Wall<T> made{number<T>(*wall.position),
               number<T>(wall.speed),
               wall.temperature ? T(1) : number<T>(wall.restitution),
               wall.temperature ? wall.temperature->value : 0,
               initial.seed,
               initial.replica};
  if (wall.shaken()) {
    made.motion = std::make_shared<const WallMotion<T>>(shape_of(wall.motion), number<T>(wall.amplitude),
                                                        number<T>(wall.frequency), number<T>(wall.phase));
  }
  if (wall.rest_speed) made.rest_speed = number<T>(*wall.rest_speed);
  return made;
}

// The distance of a particle to the wall beside it. Nothing for balls: they enclose differences of their own numbers.
template <Real T>
std::optional<AtWall<T>> at_wall_in(const Scene& scene, End end, const Displacement& displacement,
                                    const cradle::Particles<T>& particles, const std::optional<Wall<T>>& wall) {
  if constexpr (requires(const T& x) { x.radius(); }) return {};
  if (!wall) return {};
  const T v = particles.velocity(end == End::left ? 0 : particles.count() - 1);
  AtWall<T> at{T(0), end == End::left ? T(wall->speed - v) : T(v - wall->speed)};
  if (const auto* gas = dynamic_cast<const Gas<T>*>(&particles)) {
    at.gap = gas->gap_to(end);
    return at;
  }
  const auto text = at_wall(scene, end, displacement);
  if (!text) return {};
  at.gap = from_text<T>(text->gap);
  if (text->closing_speed) at.closing_speed = from_text<T>(*text->closing_speed);
  return at;
}

}  // namespace detail

/// The place of the first of these keys that the scene gives, or of the initial state.
inline Place place_of_any(const Scene& scene, std::initializer_list<const char*> keys) {
  const auto* const key = std::ranges::find_if(keys, [&](const char* k) { return scene.places.contains(k); });
  return scene.place(key == keys.end() ? "initial" : *key);
}

/// Throws Error if this precision cannot represent the scene's particles, or if its walls do not fit beside them.
template <Real T> std::shared_ptr<const cradle::Particles<T>> initial_particles(const Scene& scene) {
  std::shared_ptr<const cradle::Particles<T>> particles;
  bool summed = false;
  try {
    const Displacement displacement = displacement_of(scene.initial);
    particles = detail::particles_without_walls<T>(scene.initial, scene.walls, displacement);
    require_sums(*particles);
    summed = true;
    if (!scene.walls.any() && !scene.gravity.acts()) return particles;
    auto left = detail::wall_of<T>(scene.walls.left, scene.initial),
         right = detail::wall_of<T>(scene.walls.right, scene.initial);
    auto at_left = detail::at_wall_in<T>(scene, End::left, displacement, *particles, left),
         at_right = detail::at_wall_in<T>(scene, End::right, displacement, *particles, right);
    return std::make_shared<Walled<T>>(particles, std::move(left), std::move(right),
                                       scene.gravity.acts() ? number<T>(*scene.gravity.acceleration) : T(0),
                                       std::move(at_left), std::move(at_right));
  } catch (const std::invalid_argument& error) {
    const Place cause =
        !particles ? scene.place("initial")
        : summed   ? scene.place(scene.walls.any() ? "walls" : "gravity")
        : is_finite(particles->total_mass())
            ? place_of_any(scene, {"initial.v", "initial.speed", "initial.left.speed", "initial.right.speed",
                                   "initial.energy", "initial.variance"})
            : place_of_any(scene, {"initial.m", "initial.masses", "initial.random_masses", "initial.centre.mass"});
    throw Error(cause.prefix() + error.what());
  }
}

}  // namespace cradle::tools
