// What is chosen by the scalar type of a scene: its name, the digits of MPFR, engines and roundings.
#include "cradle/tools/engines/any_engine.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <type_traits>

#include "cradle/precision/scalars.hpp"

namespace cradle::tools {

// Compiled once per scalar type, in a separate source in instances/ of the build tree.
template <class T> std::unique_ptr<AnyEngine> begin_engine_in(const Scene& scene, const EngineOptions& options);
template <Real T> Number rounded_once(std::string_view decimal);

namespace {

// The scene's name for its scalar type.
ScalarChoice scalar_choice(const Run& run) {
  const ScalarRow& type = scalar_row(run.precision);
  return {std::string(type.name), type.digits == 0 ? static_cast<unsigned>(run.digits) : 0};
}

// Calls f(std::type_identity<T>) with the scene's scalar type. Throws Error at this key if this build does not have it,
// or for what f refuses.
template <class Result, class F> Result in_precision(const Scene& scene, const char* key, F f) {
  try {
    return with_scalar<Result>(scalar_choice(scene.run), f);
  } catch (const std::invalid_argument& error) {
    throw Error(scene.place(key).prefix() + error.what());
  }
}

}  // namespace

std::string precision_name(const Run& run) {
  const ScalarChoice choice = scalar_choice(run);
  return choice.digits > 0 ? fmt::format("{}, {} digits", choice.name, choice.digits) : choice.name;
}

void set_digits(const Scene& scene) {
  in_precision<void>(scene, "run.precision", [](auto) {});
}

std::unique_ptr<AnyEngine> begin_engine(const Scene& scene, const EngineOptions& options) {
  if (options.restitution && scene.run.precision != Precision::double_)
    throw Error(scene.place("run.precision"), "a restitution that is a function is of type double",
                precision_name(scene.run), "give run.precision = \"double\"");
  return in_precision<std::unique_ptr<AnyEngine>>(
      scene, scene.run.coordinates == Coordinates::absolute ? "run.coordinates" : "initial",
      [&]<class T>(std::type_identity<T>) { return begin_engine_in<T>(scene, options); });
}

Rounding rounding(const Scene& scene) {
  return in_precision<Rounding>(scene, "run.precision",
                                []<class T>(std::type_identity<T>) -> Rounding { return rounded_once<T>; });
}

}  // namespace cradle::tools
