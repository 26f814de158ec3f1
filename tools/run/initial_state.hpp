// From a scene to the bodies of the engine, every number read in the working precision.
#pragma once

#include <memory>
#include <optional>

#include "cradle/core/list.hpp"
#include "cradle/core/ring.hpp"
#include "cradle/core/rows.hpp"
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

/// Throws Error where the scene's bodies cannot be had in this precision.
template <Real T> std::shared_ptr<const cradle::Bodies<T>> initial_bodies(const Scene& scene) {
  const Initial& initial = scene.initial;
  try {
    if (initial.type == InitialType::list)
      return std::make_shared<List<T>>(numbers<T>(initial.x), numbers<T>(initial.v), numbers<T>(initial.m));
    const Displacement displacement = uniform_displacement(initial.perturbation.value, initial.seed, initial.replica);
    if (initial.type == InitialType::ring) {
      using std::sqrt;
      const VelocityDraw draw = initial.velocities == Velocities::gaussian
                                    ? gaussian_velocity(initial.seed, initial.replica)
                                    : uniform_velocity(initial.seed, initial.replica);
      return std::make_shared<Ring<T>>(static_cast<BodyIndex>(initial.particles), number<T>(initial.length),
                                       T(sqrt(number<T>(initial.variance))), draw, displacement);
    }
    if (!initial.general_rows())
      return std::make_shared<Rows<T>>(symmetric_rows<T>(static_cast<BodyIndex>(initial.particles),
                                                         number<T>(initial.speed), number<T>(initial.spacing),
                                                         displacement));
    const auto row = [](const Row& r) {
      return cradle::Row<T>{static_cast<BodyIndex>(r.particles), number<T>(r.speed), T(1) / number<T>(r.density)};
    };
    std::optional<CentralBody<T>> centre;
    if (initial.centre.mass.value > 0)
      centre = CentralBody<T>{number<T>(initial.centre.mass), number<T>(initial.centre.speed)};
    return std::make_shared<Rows<T>>(row(initial.left), row(initial.right), centre, displacement);
  } catch (const std::invalid_argument& error) {
    throw Error({scene.name, 0, "initial"}, "the bodies cannot be set up", error.what(), "change the scene");
  }
}

}  // namespace cradle::tools
