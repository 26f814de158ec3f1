// A scene as text, from the table of fields: the effective scene, the keys that differ from their defaults, the manual.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <regex>

#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {
namespace {

// Compares values: 1.0 does not differ from a default of 1.
bool is_default(const Field& field, const Scene& scene) {
  if (field.fallback == "required") return false;
  if (field.fallback.empty()) return !value_text(field, scene);
  Scene other = scene;
  store_default(field, other);
  return same_value(field, other, scene);
}

// A list for people: the decimals that sums and differences make, 28e-1, as 2.8.
std::string with_points(std::string text) {
  static const std::regex whole(R"([\[ -](\d\d+e-\d\d?)[,\]])");
  for (std::smatch found; std::regex_search(text, found, whole);) {
    const auto never = [](std::int64_t, std::int64_t) { return false; };
    text.replace(found[1].first, found[1].second, decimal_text(literal_of(found.str(1)), never));
  }
  return text;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> values(const Scene& scene, bool all) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const Field& field : scene_fields()) {
    if (!field.when->holds(scene) || !field.recorded) continue;
    const auto text = value_text(field, scene);
    if (text && (all || !is_default(field, scene))) result.emplace_back(field.key, *text);
  }
  return result;
}

std::string shortened(const std::string& value) {
  constexpr std::size_t most = 400;
  if (value.empty() || value.front() != '[') return value;
  if (value.size() <= most) return with_points(value);
  const auto numbers = static_cast<std::size_t>(std::count(value.begin(), value.end(), ',')) + 1;
  const auto first = value.find(',', value.find(',') + 1), last = value.rfind(',');
  return with_points(fmt::format("{}, ...{} ({} values)", value.substr(0, first), value.substr(last), numbers));
}

std::string effective_toml(const Scene& scene) {
  std::string text;
  std::string_view open_table;
  for (const auto& all = values(scene, true); const auto& [key, value] : all) {
    const auto dot = key.find('.');
    const std::string_view table = dot == key.npos ? std::string_view() : std::string_view(key).substr(0, dot);
    if (table != open_table) {
      text += fmt::format("\n[{}]\n", table);
      open_table = table;
    }
    text += fmt::format("{} = {}\n", dot == key.npos ? key : key.substr(dot + 1), value);
  }
  return text;
}

std::string facts(const Field& field) {
  std::string text(type_name(field));
  if (takes_times(field)) text += " or range";
  if (!field.range.empty() && field.range != "(-inf, inf)") text += fmt::format(" {}", field.range);
  if (!field.unit.empty()) text += fmt::format(", in {}", field.unit);
  if (field.fallback == "required") return text + ", required";
  return field.fallback.empty() ? text : text + fmt::format(", default {}", field.fallback);
}

std::string describe_fields() {
  std::string text;
  for (const Field& field : scene_fields()) {
    text += fmt::format("{}  ({})\n    {}", field.key, facts(field), field.doc);
    text += field.when->text.empty() ? std::string("\n") : fmt::format("; with {}\n", field.when->text);
  }
  return text;
}

std::string scene_difference(const Scene& found, const Scene& wanted) {
  const auto of_found = values(found, true), of_wanted = values(wanted, true);
  const std::map<std::string, std::string> old(of_found.begin(), of_found.end());
  for (const auto& [key, value] : of_wanted) {
    const auto at = old.find(key);
    if (at == old.end()) return fmt::format("no {}, here {}", key, shortened(value));
    if (at->second != value) return fmt::format("{} = {}, here {}", key, shortened(at->second), shortened(value));
  }
  return of_found.size() == of_wanted.size() ? "" : "keys that this one has not";
}

}  // namespace cradle::tools
