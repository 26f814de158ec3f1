#include "cradle/tools/run/run.hpp"

#include <fmt/format.h>

#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

[[noreturn]] void not_built(const std::string& key, const std::string& found, const std::string& built) {
  throw Error({"", 0, key}, "not in this build", found, "choose " + built);
}

}  // namespace

std::vector<Attribute> provenance(const Scene& scene, const std::string& precision, std::string_view outcome) {
  return {{"format_version", format_version}, {"cradle_version", std::string(version)},
          {"scene", effective_toml(scene)},   {"name", scene.name},
          {"precision", precision},           {"outcome", std::string(outcome)}};
}

Scene scene_in(const std::vector<Attribute>& attributes, const std::string& file) {
  Scene scene = parse_scene(attribute<std::string>(attributes, "scene", file), file);
  if (const auto* name = find_attribute<std::string>(attributes, "name")) scene.name = *name;
  return scene;
}

void check_built(const Scene& scene) {
  if (scene.initial.type == InitialType::clusters && scene.run.precision != Precision::double_)
    not_built("run.precision", precision_name(scene.run) + " with initial.type = \"clusters\"", "double");
  if (scene.run.coordinates == Coordinates::absolute) {
    if (particles_merge(scene)) not_built("run.coordinates", "absolute with particles that merge", "gaps");
    if (scene.initial.on_ring()) not_built("run.coordinates", "absolute on a ring", "gaps");
  }
  set_digits(scene);
  const Decimal &start = scene.run.start, &until = scene.run.until;
  const Rounding round = rounding(scene);
  if (start < until && !(round(start.text) < round(until.text)))  // it would end at its start
    throw Error(scene.place("run.until"), "too close to run.start for this precision",
                fmt::format("{} after {}, which are the same in {}", until.text, start.text, precision_name(scene.run)),
                "count times from 0 (run.start = 0), or give more digits (run.precision)");
}

Scene without_tables(Scene scene) {
  for (const MeasurementRow* row : measurement_rows())
    if (row->leave_out) row->leave_out(scene.output);
  return scene;
}

void SceneRun::require_in_progress() const {
  if (over_)
    throw Error({scene_.name}, "the run is over", std::string(end_row(over_->end).text) + " at t = " + time().text(),
                "write its result, or begin another one");
}

RunOutcome run_scene(const Scene& scene, const RunOptions& options, Sink& sink) {
  if (scene.initial.type == InitialType::clusters) return check_built(scene), run_clusters(scene, options, sink);
  const std::unique_ptr<SceneRun> run = begin_run(scene, options, sink);
  notify(options.announcement);
  run->advance(scene.run.until);
  return *run->over();
}

RunOutcome run_scene(const Scene& scene, const RunOptions& options) {
  MemorySink sink;
  RunOutcome end = run_scene(scene, options, sink);
  end.result = std::move(sink).result();
  return end;
}

}  // namespace cradle::tools
