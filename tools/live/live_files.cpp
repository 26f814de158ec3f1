#include "cradle/tools/live/live_files.hpp"

#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/store/checkpoint.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tools {

namespace {

// The kind of these checkpoints (JournalHeader::kind).
constexpr const char* live_kind = "simulation";

}  // namespace

void save_live_run(LiveRun& run, const std::string& path) {
  const FileClaim claim(path);
  const Scene& scene = run.scene();
  StateWriter to(path,
                 {{live_kind, 0, effective_toml(scene), scene.name}, 0, 0, 0, run.time(), run.counts().collisions});
  run.save(to);
  to.finish();
}

std::unique_ptr<LiveRun> load_live_run(const std::string& path, const LiveOptions& options) {
  StateReader from(path);
  const JournalHeader& header = from.header().run;
  if (header.kind != live_kind)
    throw Error({path, 0, ""}, "a checkpoint of another command", header.kind, "continue it with `cradle resume`",
                Exit::io);
  Scene scene = parse_scene(header.scene, path);
  scene.name = header.name;
  return live_run(scene, options, &from);
}

void write_live_run(LiveRun& run, const std::string& path, Force force) {
  run.require_result();
  const FileClaim claim(path);
  check_overwrite(path, "run", &run.scene(), force);
  write_or_keep(run.result(), path);
}

}  // namespace cradle::tools
