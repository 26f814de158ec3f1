// From a scene to the bodies of the engine, every number read in the working precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cradle/core/cold.hpp"
#include "cradle/core/list.hpp"
#include "cradle/core/ring.hpp"
#include "cradle/core/rows.hpp"
#include "cradle/core/walled.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

template <Real T> T number(const Decimal& decimal) { return from_text<T>(decimal.text); }

template <Real T> std::vector<T> numbers(const DecimalColumn& column) {
  std::vector<T> values;
  values.reserve(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) values.push_back(from_text<T>(column[i]));
  return values;
}

template <Real T> MassPattern<T> mass_pattern(const Initial& initial) {
  std::vector<T> masses;
  bool identical = true;
  for (const Decimal& mass : initial.masses) {
    masses.push_back(number<T>(mass));
    identical = identical && mass == initial.masses.front();
  }
  return MassPattern<T>(std::move(masses), identical);
}

template <Real T>
std::shared_ptr<const cradle::Bodies<T>> cold_bodies(const Initial& initial, Displacement displacement) {
  const auto all = static_cast<BodyIndex>(initial.particles), hot = static_cast<BodyIndex>(initial.hot);
  const auto place = initial.place == HotPlace::left ? cradle::HotPlace::left : cradle::HotPlace::middle;
  const BodyIndex first = first_hot(place, all, hot);
  MassPattern<T> masses = mass_pattern<T>(initial);
  HotBodies<T> moving = hot == 1 ? kicked(first, number<T>(initial.speed))
                                 : heated(first, hot, number<T>(initial.energy), masses, initial.seed, initial.replica);
  return std::make_shared<Cold<T>>(all, number<T>(initial.spacing), place, std::move(moving), std::move(displacement),
                                   std::move(masses));
}

namespace detail {

template <Real T> std::shared_ptr<const cradle::Bodies<T>> bodies_without_walls(const Initial& initial) {
  if (initial.type == InitialType::list) {
    const auto momentum = sum_of_products(initial.v, initial.m);
    return std::make_shared<List<T>>(numbers<T>(initial.x), numbers<T>(initial.v), numbers<T>(initial.m), T(0),
                                     momentum ? std::optional<T>(from_text<T>(*momentum)) : std::nullopt);
  }
  // Below 1/2, whatever the nearest double is.
  const double perturbation = std::min(initial.perturbation.value, std::nextafter(0.5, 0.));
  const Displacement displacement = uniform_displacement(perturbation, initial.seed, initial.replica);
  if (initial.type == InitialType::cold) return cold_bodies<T>(initial, displacement);
  if (initial.type == InitialType::ring) {
    using std::sqrt;
    const VelocityDraw draw = initial.velocities == Velocities::gaussian
                                  ? gaussian_velocity(initial.seed, initial.replica)
                                  : uniform_velocity(initial.seed, initial.replica);
    return std::make_shared<Ring<T>>(static_cast<BodyIndex>(initial.particles), number<T>(initial.length),
                                     T(sqrt(number<T>(initial.variance))), draw, displacement,
                                     mass_pattern<T>(initial));
  }
  if (!initial.general_rows())
    return std::make_shared<Rows<T>>(symmetric_rows<T>(static_cast<BodyIndex>(initial.particles),
                                                       number<T>(initial.speed), number<T>(initial.spacing),
                                                       displacement, mass_pattern<T>(initial)));
  const auto row = [](const Row& r) {
    return cradle::Row<T>{static_cast<BodyIndex>(r.particles), number<T>(r.speed), T(1) / number<T>(r.density)};
  };
  std::optional<CentralBody<T>> centre;
  if (initial.centre.mass > Decimal("0"))
    centre = CentralBody<T>{number<T>(initial.centre.mass), number<T>(initial.centre.speed)};
  return std::make_shared<Rows<T>>(row(initial.left), row(initial.right), centre, displacement,
                                   mass_pattern<T>(initial));
}

template <Real T> std::optional<Wall<T>> wall_of(const WallAt& wall, const Initial& initial) {
  if (!wall.position) return {};
  return Wall<T>{number<T>(*wall.position),
                 number<T>(wall.speed),
                 wall.temperature ? T(1) : number<T>(wall.restitution),
                 wall.temperature ? wall.temperature->value : 0,
                 initial.seed,
                 initial.replica};
}

}  // namespace detail

/// Throws Error where the scene's bodies cannot be had in this precision, or its walls not beside them.
template <Real T> std::shared_ptr<const cradle::Bodies<T>> initial_bodies(const Scene& scene) {
  try {
    auto bodies = detail::bodies_without_walls<T>(scene.initial);
    require_sums(*bodies);
    if (!scene.walls.any()) return bodies;
    return std::make_shared<Walled<T>>(std::move(bodies), detail::wall_of<T>(scene.walls.left, scene.initial),
                                       detail::wall_of<T>(scene.walls.right, scene.initial));
  } catch (const std::invalid_argument& error) {
    throw Error({scene.name, 0, scene.walls.any() ? "initial, walls" : "initial"}, "the bodies cannot be set up",
                error.what(), "change the scene");
  }
}

}  // namespace cradle::tools
