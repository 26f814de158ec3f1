#include "cradle/tools/scene/checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/support/spelling.hpp"

namespace cradle::tools {
namespace {

std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

// The most similar known key, of several the shortest; empty if none is similar. The right name in the wrong table
// counts as similar.
std::string_view nearest_key(std::string_view key) {
  std::string_view nearest;
  std::size_t least = alike(key) + 1;
  for (const Field& field : scene_fields()) {
    std::size_t distance = edit_distance(key, field.key);
    if (last_part(key) == last_part(field.key)) distance = std::min<std::size_t>(distance, 2);
    if (distance < least || (distance == least && field.key.size() < nearest.size())) {
      least = distance;
      nearest = field.key;
    }
  }
  return nearest;
}

// Keys that users may expect in this table, and what to do instead.
struct OtherNames {
  std::string_view table;
  std::vector<std::string_view> names;
  std::string_view advice;
};
const OtherNames other_names[] = {
    {"initial", {"temperature"}, "give initial.variance, the temperature over the mass: T for particles of mass 1"},
    {"initial",
     {"diameter", "diameters", "radius", "size"},
     "particles are points; a rod of the length d is one whose distances to all that it meets are shorter by d"},
    {"law", {"epsilon", "e", "r"}, "did you mean law.restitution?"},
    {"gravity", {"g"}, "did you mean gravity.acceleration?"},
    {"initial", {"n", "N"}, "did you mean initial.particles?"},
    {"run", {"time", "end"}, "did you mean run.until?"},
};

void refuse_unknown_key(std::string_view key, const Value& value) {
  const auto is_inside = [](std::string_view inner, std::string_view outer) {
    return inner.size() > outer.size() && inner.starts_with(outer) && inner[outer.size()] == '.';
  };
  for (const Field& field : scene_fields()) {
    if (field.key == key) return;
    if (is_inside(field.key, key)) {
      if (value.kind == Value::Kind::table) return;  // an empty table has no keys
      throw Error(value.place, "wrong type", describe(value), fmt::format("give a table, such as {} = ...", field.key));
    }
  }
  for (const OtherNames& other : other_names)
    for (const std::string_view name : other.names)
      if (key == fmt::format("{}.{}", other.table, name))
        throw Error(value.place, "unknown key", describe(value), other.advice);
  const auto nearest = nearest_key(key);
  throw Error(value.place, "unknown key", describe(value),
              nearest.empty() ? "remove it; the manual lists all keys" : fmt::format("did you mean {}?", nearest));
}

// Why a key does not apply: names the deciding key and its value.
std::string decided_by(const Condition& when, const Scene& scene) {
  const Field* field = find_field(when.decided_by, scene);
  while ((!field->when->holds(scene) || !value_text(*field, scene)) && !field->when->decided_by.empty())
    field = find_field(field->when->decided_by, scene);
  return fmt::format("{} = {}", field->key, value_text(*field, scene).value_or("none"));
}

// All scenes that take this key: `law.type = "wet"`.
std::string belongs_to(std::string_view key) {
  std::vector<std::string_view> scenes;
  for (const Field& field : scene_fields())
    if (field.key == key && std::ranges::find(scenes, field.when->text) == scenes.end())
      scenes.push_back(field.when->text);
  return fmt::format("{}", fmt::join(scenes, " or "));
}

}  // namespace

void gather_tables(Entries& entries) {
  for (const Field& field : scene_fields()) {
    const std::string inside = std::string(field.key) + '.';
    Value table{Value::Kind::table, "", {}, {}};
    std::erase_if(entries, [&](const auto& entry) {
      if (!entry.first.starts_with(inside)) return false;
      const Place& place = entry.second.place;
      if (table.place.key.empty() || place.line < table.place.line)
        table.place = {place.source, place.line, std::string(field.key)};
      return true;
    });
    if (!table.place.key.empty()) entries.emplace(field.key, std::move(table));
  }
}

void refuse_unknown_keys(const Entries& entries) {
  for (const auto& [key, value] : entries) refuse_unknown_key(key, value);
}

void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider) {
  for (const auto& [key, value] : entries) {
    const Field* field = find_field(key, scene);
    if (field == nullptr || (!decider.empty() && field->when->decided_by != decider)) continue;
    if (field->when->holds(scene)) continue;
    // A key of the file that the command line has made inapplicable.
    const auto decides = entries.find(std::string(field->when->decided_by));
    const bool by_command = decides != entries.end() && decides->second.place.source == "--set";
    const std::string how = by_command && value.place.source != "--set" ? fmt::format(" by `--set {}=`", key) : "";
    throw Error(value.place, field->when->otherwise, decided_by(*field->when, scene),
                fmt::format("remove it{}, it belongs to {}", how, belongs_to(key)));
  }
}

}  // namespace cradle::tools
