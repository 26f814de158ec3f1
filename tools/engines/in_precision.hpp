// Calls code with the scalar type of a scene.
#pragma once

#include <stdexcept>

#include "cradle/precision/scalars.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// The scene's name for its scalar type.
ScalarChoice scalar_choice(const Run& run);

/// Calls f(std::type_identity<T>) with the scene's scalar type. Throws Error if this build does not have it.
template <class Result, class F> Result in_precision(const Scene& scene, F f) {
  try {
    return with_scalar<Result>(scalar_choice(scene.run), f);
  } catch (const std::invalid_argument& error) {
    throw Error({"", 0, "run.precision"}, "not available", scalar_choice(scene.run).name, error.what());
  }
}

}  // namespace cradle::tools
