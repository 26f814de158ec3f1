// From a scene's precision to a type.
#pragma once

#include <stdexcept>

#include "cradle/precision/scalars.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// What the scene calls its scalar type.
ScalarChoice scalar_choice(const Run& run);

/// Calls f(std::type_identity<T>) with the scene's scalar type; throws Error where this build has none such.
template <class Result, class F> Result in_precision(const Scene& scene, F f) {
  try {
    return with_scalar<Result>(scalar_choice(scene.run), f);
  } catch (const std::invalid_argument& error) {
    throw Error({"", 0, "run.precision"}, "not available", scalar_choice(scene.run).name, error.what());
  }
}

}  // namespace cradle::tools
