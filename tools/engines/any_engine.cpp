#include "cradle/tools/engines/any_engine.hpp"

#include <type_traits>

#include "cradle/tools/engines/in_precision.hpp"
#include "cradle/tools/engines/precision.hpp"

namespace cradle::tools {

// Compiled once per scalar type, in a separate source in instances/ of the build tree.
template <class T> std::unique_ptr<AnyEngine> begin_engine_in(const Scene& scene, const EngineOptions& options);
template <Real T> Number rounded_once(std::string_view decimal);

std::unique_ptr<AnyEngine> begin_engine(const Scene& scene, const EngineOptions& options) {
  if (options.restitution && scene.run.precision != Precision::double_)
    throw Error(scene.place("run.precision"), "a restitution that is a function is of type double",
                precision_name(scene.run), "give run.precision = \"double\"");
  return in_precision<std::unique_ptr<AnyEngine>>(
      scene, [&]<class T>(std::type_identity<T>) { return begin_engine_in<T>(scene, options); });
}

Rounding rounding(const Scene& scene) {
  return in_precision<Rounding>(scene, []<class T>(std::type_identity<T>) -> Rounding { return rounded_once<T>; });
}

}  // namespace cradle::tools
