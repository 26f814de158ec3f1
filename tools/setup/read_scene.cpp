#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cradle/tools/scene/checks.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/keys.hpp"
#include "cradle/tools/scene/overrides.hpp"
#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/word_start.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/spelling.hpp"

namespace cradle::tools {
namespace {

bool has_row_tables(const Entries& entries) {
  return std::ranges::any_of(entries, [](const auto& entry) {
    return entry.first.starts_with("initial.left") || entry.first.starts_with("initial.right") ||
           entry.first.starts_with("initial.centre");
  });
}

void store_all(const Entries& entries, const std::string& scene_file, Scene& scene) {
  for (const Field& field : scene_fields()) {
    // The tables decide which keys rows take, so they are inspected before these keys are read.
    if (field.key == "initial.left.particles" && scene.initial.type == InitialType::rows && has_row_tables(entries))
      scene.initial.left.particles = 1;
    if (!field.when->holds(scene)) continue;
    if (const auto entry = entries.find(field.key); entry != entries.end()) {
      store(field, entry->second, scene);
    } else if (field.fallback == "required") {
      // If a key of another law is present, it explains the error better than the missing key.
      if (!field.when->decided_by.empty()) refuse_inapplicable_keys(entries, scene, field.when->decided_by);
      throw Error({scene_file, 0, std::string(field.key)}, "missing", "", advice(field, scene));
    } else {
      store_default(field, scene);
    }
  }
}

// Replaces the gaps of a list by the places that they add up to.
void place_particles(const Entries& entries, Scene& scene) {
  Initial& initial = scene.initial;
  const auto given = entries.find("initial.gap");
  if (given == entries.end() || initial.file || initial.v.empty()) return;
  if (initial.gap.empty() && initial.v.size() > 1)
    throw Error(given->second.place, "no gaps", "an empty list",
                "give one less than there are particles, or remove it");
  auto placed =
      tools::placed({std::move(initial.x), std::move(initial.v), std::move(initial.m), std::move(initial.gap), {}},
                    initial.length, given->second.place);
  initial.x = std::move(placed.x), initial.v = std::move(placed.v), initial.m = std::move(placed.m);
  initial.gap = {};
}

void sort_times(Scene& scene) {
  for (const Field& field : scene_fields()) {
    const auto* const list = std::get_if<Member<std::vector<Decimal>>>(&field.storage);
    if (list == nullptr || field.unit != "t") continue;
    std::vector<Decimal>& times = (*list)(scene);
    if (!std::ranges::is_sorted(times)) std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }
}

// What to do about a scene that is not there: the similar name of a file beside it or of a bundled scene.
std::string similar_scene(const std::filesystem::path& path) {
  std::vector<std::string> names;
  std::error_code none;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".toml") names.push_back((path.parent_path() / entry.path().filename()).string());
  std::ranges::sort(names);
  for (const BundledScene& scene : bundled_scenes()) names.emplace_back(scene.name);
  const auto nearest = nearest_word(path.string(), names);
  return nearest.empty() ? "give the path of a scene file, or one of the names that `cradle scenes` lists"
                         : fmt::format("did you mean {}?", nearest);
}

Scene scene_of(const Entries& entries, const std::string& source_name) {
  Scene scene;
  const std::filesystem::path path(source_name);
  scene.name = path.stem().string();
  refuse_unknown_keys(entries);
  store_all(entries, source_name, scene);
  refuse_inapplicable_keys(entries, scene);
  place_particles(entries, scene);
  check_scene(scene, entries, source_name);
  sort_times(scene);
  for (const auto& [key, value] : entries) scene.places.emplace(key, value.place);
  // Either becomes a list of particles: a file, or a word, which is kept in the same place until then.
  if (const auto word = entries.find("initial.word"); word != entries.end())
    start_from_word(word->second.place, scene);
  else if (scene.initial.file)
    read_list(path.parent_path() / *scene.initial.file, scene);
  if (scene.output.word) check_word(entries.at("output.word").place, scene);
  return scene;
}

struct SceneText {
  std::string text, source;
};

SceneText text_of(const std::string& path_or_name) {
  std::error_code unreadable;
  const bool exists = std::filesystem::exists(path_or_name, unreadable);
  if (exists && !std::filesystem::is_directory(path_or_name, unreadable)) {
    if (const auto found = instead_of_file(path_or_name); !found.empty())
      throw Error({path_or_name, 0, {}}, "not a scene file", found, "save the scene in a file and give this", Exit::io);
    std::ifstream file(path_or_name, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file || file.bad())
      throw Error({path_or_name, 0, {}}, "cannot be read", "a file that does not open", "check its permissions",
                  Exit::io);
    if (text.starts_with("\x89HDF"))
      throw Error({path_or_name, 0, {}}, "a result, not a scene", "HDF5",
                  "give the scene file, or inspect it with `cradle info " + path_or_name + "`");
    return {std::move(text), path_or_name};
  }
  for (const BundledScene& scene : bundled_scenes())
    if (scene.name == path_or_name) return {std::string(scene.text), path_or_name + ".toml"};
  throw Error({path_or_name, 0, {}}, "no such scene", exists ? "a folder" : "neither a file nor a bundled scene",
              similar_scene(path_or_name), Exit::io);
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& source_name, const std::vector<std::string>& overrides) {
  Entries entries = read_entries(text, source_name);
  apply_overrides(entries, overrides);
  gather_tables(entries);
  return scene_of(entries, source_name);
}

Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  const SceneText scene = text_of(path_or_name);
  return parse_scene(scene.text, scene.source, overrides);
}

std::string times_left_out(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  const SceneText scene = text_of(path_or_name);
  Entries entries = read_entries(scene.text, scene.source);
  return apply_overrides(entries, overrides);
}

}  // namespace cradle::tools
