#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cradle/tools/scene/checks.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/source.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/word_start.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/spelling.hpp"

namespace cradle::tools {
namespace {

// If the command line chooses how to sample the series, removes the choice of the file.
void drop_replaced_series(Entries& entries, std::string_view assignment) {
  constexpr std::string_view series = "output.series.";
  const auto key = key_of(assignment);
  if (!key.starts_with(series)) return;
  const auto way = key.substr(series.size());
  const bool of_range = way.starts_with("times.");
  if (way != "points" && way != "every" && way != "times" && !of_range) return;
  std::erase_if(entries, [&](const auto& entry) {
    return entry.first.starts_with(series) && !(way == "points" && entry.first == "output.series.spacing") &&
           !(of_range && entry.first.starts_with("output.series.times."));
  });
}

// If the command line changes the span of a run, removes the file's output times outside of it. Output times on the
// command line are kept, and refused later. Returns what was removed: "output.snapshots (500, 1000)".
std::vector<std::string> drop_times_cut_off(Entries& entries) {
  const auto bound = [&](const char* key) -> std::optional<Decimal> {
    const auto entry = entries.find(key);
    if (entry == entries.end() || entry->second.place.source != "--set") return std::nullopt;
    const auto literal = canonical_decimal(entry->second.text);
    return literal ? std::optional(Decimal(*literal)) : std::nullopt;
  };
  const auto start = bound("run.start"), until = bound("run.until");
  std::vector<std::string> left_out;
  for (const Field& field : scene_fields()) {
    const auto entry = takes_times(field) ? entries.find(field.key) : entries.end();
    if (entry == entries.end() || entry->second.place.source == "--set") continue;
    std::vector<std::string> dropped;
    std::erase_if(entry->second.items, [&](const Value& item) {
      const auto literal = canonical_decimal(item.text);
      const bool outside = literal && ((start && Decimal(*literal) < *start) || (until && Decimal(*literal) > *until));
      if (outside) dropped.push_back(item.text);
      return outside;
    });
    if (dropped.empty()) continue;
    const std::string times = dropped.size() > 6
                                  ? fmt::format("{} times, {} to {}", dropped.size(), dropped.front(), dropped.back())
                                  : fmt::format("{}", fmt::join(dropped, ", "));
    left_out.push_back(fmt::format("{} ({})", field.key, times));
    if (entry->second.items.empty()) entries.erase(entry);
  }
  return left_out;
}

// Applies `--set` assignments, each `table.key=value`, see apply_override; ranges of times become lists. Returns a line
// for the user if a new run.start or run.until leaves out times of the scene, else nothing. Throws Error for anything
// else.
std::string apply_overrides(Entries& entries, const std::vector<std::string>& overrides) {
  for (const auto& assignment : overrides) {
    drop_replaced_series(entries, assignment);
    apply_override(entries, assignment);
  }
  expand_time_ranges(entries);
  const auto left_out = drop_times_cut_off(entries);
  if (left_out.empty()) return "";
  return fmt::format("times of the scene outside the run are left out: {}; --set KEY=[T, ...] gives others\n",
                     fmt::join(left_out, ", "));
}

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
      throw Error({scene_file, 0, std::string(field.key)}, "missing", "",
                  fmt::format("{} ({})", advice(field, scene), field.doc));
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
  for (const EmbeddedFile& scene : bundled_scenes()) names.emplace_back(scene.name);
  const auto nearest = nearest_word(path.string(), names);
  return nearest.empty() ? "give the path of a scene file, or one of the names that `cradle scenes` lists"
                         : fmt::format("did you mean {}?", nearest);
}

// A single particle meets walls alone, whose restitution is 1 unless it is given.
void note_idle_restitution(Scene& scene) {
  const bool loses = scene.law.type == LawType::inelastic && scene.law.restitution < Decimal("1");
  if (!loses || scene.initial.type != InitialType::list || scene.initial.x.size() != 1) return;
  for (const auto& [name, wall] :
       {std::pair("walls.left", &scene.walls.left), std::pair("walls.right", &scene.walls.right)})
    if (wall->position && !wall->temperature && !scene.places.contains(name + std::string(".restitution")))
      scene.remarks += fmt::format("{}acts on nothing, since a single particle meets no other (found {}): give "
                                   "{}.restitution, that of the wall, which is 1 here\n",
                                   scene.place("law.restitution").prefix(), scene.law.restitution.text, name);
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
  note_idle_restitution(scene);
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& source_name, const std::vector<std::string>& overrides) {
  Entries entries = read_entries(text, source_name);
  const std::string left_out = apply_overrides(entries, overrides);
  gather_tables(entries);
  Scene scene = scene_of(entries, source_name);
  scene.remarks.insert(0, left_out);
  return scene;
}

Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides,
                 const std::vector<std::string>& first_values) {
  try {
    return read_scene(path_or_name, overrides);
  } catch (const Error&) {
    if (first_values.empty()) throw;
    std::vector<std::string> all = overrides;
    all.insert(all.end(), first_values.begin(), first_values.end());
    return read_scene(path_or_name, all);
  }
}

Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  std::error_code unreadable;
  const bool exists = std::filesystem::exists(path_or_name, unreadable);
  if (exists && !std::filesystem::is_directory(path_or_name, unreadable)) {
    if (const auto found = instead_of_file(path_or_name); !found.empty())
      throw Error({path_or_name}, "not a scene file", found, "save the scene in a file and give this", Exit::io);
    std::ifstream file(path_or_name, std::ios::binary);
    if (!file)
      throw Error({path_or_name}, "cannot be read", "a file that does not open", "check its permissions", Exit::io);
    std::string text;
    try {
      text.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    } catch (const std::ios_base::failure& error) {
      throw Error({path_or_name}, "cannot be read", error.code().message(), "give a scene file", Exit::io);
    }
    if (text.starts_with("\x89HDF"))
      throw Error({path_or_name}, "a result, not a scene", "HDF5",
                  fmt::format("give the scene file, or the csv/scene.toml that `cradle export {0} --to csv` writes; "
                              "`cradle info {0}` shows what is in it",
                              path_or_name));
    return parse_scene(text, path_or_name, overrides);
  }
  for (const EmbeddedFile& scene : bundled_scenes())
    if (scene.name == path_or_name) return parse_scene(scene.text, path_or_name + ".toml", overrides);
  throw Error({path_or_name}, "no such scene", exists ? "a folder" : "neither a file nor a bundled scene",
              similar_scene(path_or_name), Exit::io);
}

}  // namespace cradle::tools
