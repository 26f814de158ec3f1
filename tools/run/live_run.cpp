#include "cradle/tools/run/live_run.hpp"

#include "cradle/tools/engines/in_precision.hpp"

namespace cradle::tools {

// Compiled once per scalar type, in a separate source in instances/ of the build tree.
template <class T> std::unique_ptr<LiveRun> live_in(const Scene& scene, const LiveOptions& options, StateSource* from);

std::unique_ptr<LiveRun> live_run(const Scene& scene, const LiveOptions& options, StateSource* from) {
  if (options.begins) options.begins(scene);
  check_built(scene);
  if (scene.initial.type == InitialType::clusters)
    throw Error({scene.name, 0, "initial.type"}, "a model without particles", "clusters", "use `cradle run`");
  return in_precision<std::unique_ptr<LiveRun>>(
      scene, [&]<class T>(std::type_identity<T>) { return live_in<T>(scene, options, from); });
}

}  // namespace cradle::tools
