#include "cradle/tools/run/live_run.hpp"

#include "cradle/tools/model/in_precision.hpp"

namespace cradle::tools {

// Compiled once per scalar type, in a separate source in instances/ of the build tree.
template <class T> std::unique_ptr<LiveRun> live_in(const Scene& scene, const LiveOptions& options, StateReader* from);

namespace {

std::unique_ptr<LiveRun> live(const Scene& scene, const LiveOptions& options, StateReader* from) {
  if (options.begins) options.begins(scene);
  check_built(scene);
  if (scene.initial.type == InitialType::clusters)
    throw Error({scene.name, 0, "initial.type"}, "a model without particles", "clusters", "use `cradle run`");
  return in_precision<std::unique_ptr<LiveRun>>(
      scene, [&]<class T>(std::type_identity<T>) { return live_in<T>(scene, options, from); });
}

}  // namespace

std::unique_ptr<LiveRun> live_run(const Scene& scene, const LiveOptions& options) {
  return live(scene, options, nullptr);
}

std::unique_ptr<LiveRun> load_live_run(const std::string& path, const LiveOptions& options) {
  StateReader from(path);
  const JournalHeader& header = from.header().run;
  if (header.kind != live_kind)
    throw Error({path, 0, ""}, "a checkpoint of another command", header.kind, "continue it with `cradle resume`",
                Exit::io);
  Scene scene = parse_scene(header.scene, path);
  scene.name = header.name;
  return live(scene, options, &from);
}

}  // namespace cradle::tools
