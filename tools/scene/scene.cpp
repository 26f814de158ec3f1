// Reading a scene: text to entries (source.cpp), entries through the table of fields into the struct (fields.cpp),
// then the checks that need more than one key (checks.cpp).
#include "cradle/tools/scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "cradle/tools/scene/checks.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {
namespace {

// Number of letters to insert, delete, change or swap with a neighbour to get from one word to the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

// The known key most like this one, empty where none is alike. The right name in the wrong table counts as near.
std::string_view nearest_key(std::string_view key) {
  std::string_view nearest;
  std::size_t least = std::max<std::size_t>(2, key.size() / 4) + 1;
  for (const Field& field : scene_fields()) {
    std::size_t distance = edit_distance(key, field.key);
    if (last_part(key) == last_part(field.key)) distance = std::min<std::size_t>(distance, 2);
    if (distance < least) {
      least = distance;
      nearest = field.key;
    }
  }
  return nearest;
}

void refuse_unknown_key(std::string_view key, const Value& value, const Scene& scene) {
  const auto is_inside = [](std::string_view inner, std::string_view outer) {
    return inner.size() > outer.size() && inner.starts_with(outer) && inner[outer.size()] == '.';
  };
  for (const Field& field : scene_fields()) {
    if (field.key == key) return;
    if (is_inside(key, field.key))
      throw Error({value.place.source, value.place.line, std::string(field.key)}, "wrong type", "a table",
                  advice(field, scene));
    if (is_inside(field.key, key)) {
      if (value.kind == Value::Kind::table) return;  // empty: says nothing
      throw Error(value.place, "wrong type", describe(value), fmt::format("give a table, such as {} = ...", field.key));
    }
  }
  const auto nearest = nearest_key(key);
  throw Error(value.place, "unknown key", describe(value),
              nearest.empty() ? "remove it; the manual lists all keys" : fmt::format("did you mean {}?", nearest));
}

// Why a key does not apply: the deciding key with the value it has.
std::string decided_by(const When& when, const Scene& scene) {
  const Field* field = find_field(when.decided_by, scene);
  while ((!field->when->holds(scene) || !value_text(*field, scene)) && !field->when->decided_by.empty())
    field = find_field(field->when->decided_by, scene);
  return fmt::format("{} = {}", field->key, value_text(*field, scene).value_or("none"));
}

// Of the keys that `decider` decides on, or of all where it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {}) {
  for (const auto& [key, value] : entries) {
    const Field* field = find_field(key, scene);
    if (field == nullptr || (!decider.empty() && field->when->decided_by != decider)) continue;
    if (!field->when->holds(scene))
      throw Error(value.place, field->when->otherwise, decided_by(*field->when, scene),
                  fmt::format("remove it, it belongs to {}", field->when->text));
  }
}

bool has_row_tables(const Entries& entries) {
  return std::ranges::any_of(entries, [](const auto& entry) {
    return entry.first.starts_with("initial.left") || entry.first.starts_with("initial.right") ||
           entry.first.starts_with("initial.centre");
  });
}

void store_all(const Entries& entries, const std::string& scene_file, Scene& scene) {
  for (const Field& field : scene_fields()) {
    // The tables decide which keys rows take, before the first of these keys is looked at.
    if (field.key == "initial.left.particles" && scene.initial.type == InitialType::rows && has_row_tables(entries))
      scene.initial.left.particles = 1;
    if (!field.when->holds(scene)) continue;
    if (const auto entry = entries.find(field.key); entry != entries.end()) {
      store(field, entry->second, scene);
    } else if (field.fallback == "required") {
      // A key of another law says more about what went wrong than the key that is missing for it.
      if (!field.when->decided_by.empty()) refuse_inapplicable_keys(entries, scene, field.when->decided_by);
      throw Error({scene_file, 0, std::string(field.key)}, "missing", "", advice(field, scene));
    } else {
      store_default(field, scene);
    }
  }
}

void sort_times(std::vector<Decimal>& times) {
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
}

// A way to sample the series replaces another one that the file chose.
void drop_replaced_series(Entries& entries, std::string_view assignment) {
  constexpr std::string_view series = "output.series.";
  const auto key = assignment.substr(0, assignment.find_first_of("= \t"));
  if (!key.starts_with(series)) return;
  const auto way = key.substr(series.size());
  if (way != "points" && way != "every" && way != "times") return;
  std::erase_if(entries, [&](const auto& entry) {
    return entry.first.starts_with(series) && !(way == "points" && entry.first == "output.series.spacing");
  });
}

// A run cut to another span on the command line keeps those of the file's output times that lie in it: what is asked
// for on the command line itself is still refused there.
void drop_times_cut_off(Entries& entries) {
  const auto bound = [&](const char* key) -> std::optional<Decimal> {
    const auto entry = entries.find(key);
    if (entry == entries.end() || entry->second.place.source != "--set") return std::nullopt;
    const auto literal = canonical_decimal(entry->second.text);
    return literal ? std::optional(Decimal(*literal)) : std::nullopt;
  };
  const auto start = bound("run.start"), until = bound("run.until");
  for (const char* key : {"output.series.times", "output.snapshots", "output.profiles.times", "output.masses"}) {
    const auto entry = entries.find(key);
    if (entry == entries.end() || entry->second.place.source == "--set") continue;
    const auto dropped = std::erase_if(entry->second.items, [&](const Value& item) {
      const auto literal = canonical_decimal(item.text);
      return literal && ((start && Decimal(*literal) < *start) || (until && Decimal(*literal) > *until));
    });
    if (dropped > 0 && entry->second.items.empty()) entries.erase(entry);
  }
}

std::string bundled_names() {
  std::string names;
  for (const BundledScene& scene : bundled_scenes()) names.append(names.empty() ? "" : ", ").append(scene.name);
  return names;
}

}  // namespace

bool operator==(const Scene& a, const Scene& b) {
  return a.title == b.title && a.law == b.law && a.initial == b.initial && a.run == b.run && a.output == b.output &&
         a.sweep == b.sweep;
}

Scene parse_scene(std::string_view text, const std::string& source_name, const std::vector<std::string>& overrides) {
  Entries entries = read_entries(text, source_name);
  for (const auto& assignment : overrides) {
    drop_replaced_series(entries, assignment);
    apply_override(entries, assignment);
  }
  drop_times_cut_off(entries);
  Scene scene;
  const std::filesystem::path path(source_name);
  scene.name = path.stem().string();
  scene.folder = path.parent_path().string();

  for (const auto& [key, value] : entries) refuse_unknown_key(key, value, scene);
  store_all(entries, source_name, scene);
  refuse_inapplicable_keys(entries, scene);
  check_scene(scene, entries, source_name);
  sort_times(scene.output.series.times);
  sort_times(scene.output.snapshots);
  sort_times(scene.output.profiles.times);
  sort_times(scene.output.masses);
  return scene;
}

Scene read_scene(const std::string& path_or_name, const std::vector<std::string>& overrides) {
  std::error_code unreadable;
  const bool exists = std::filesystem::exists(path_or_name, unreadable);
  if (exists && !std::filesystem::is_directory(path_or_name, unreadable)) {
    std::ifstream file(path_or_name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file || file.bad())
      throw Error({path_or_name, 0, {}}, "cannot be read", "a file that does not open", "check its permissions",
                  Exit::io);
    return parse_scene(text, path_or_name, overrides);
  }
  for (const BundledScene& scene : bundled_scenes())
    if (scene.name == path_or_name) return parse_scene(scene.text, path_or_name + ".toml", overrides);
  throw Error({path_or_name, 0, {}}, "no such scene", exists ? "a folder" : "neither a file nor a bundled scene",
              "give the path of a scene file or one of " + bundled_names(), Exit::io);
}

}  // namespace cradle::tools
