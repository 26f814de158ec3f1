#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace cradle::tools {

namespace {

std::string text(const std::variant<std::string, double, std::uint64_t>& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

// In ensembles: groups with the statistics of one quantity, and groups needed for merging.
bool is_detail(const Group& group) { return group.find("mean") != nullptr || group.name.ends_with("ensemble/nodes"); }

// The names of the quantities below a group that have statistics.
std::string quantities(const Result& result, const std::string& group) {
  std::string names;
  for (const Group& other : result.groups)
    if (other.name.starts_with(group + "/") && is_detail(other))
      names += (names.empty() ? "" : ", ") + other.name.substr(group.size() + 1);
  return names;
}

// Up to the number of a table: "snapshots/" of snapshots/0007.
std::string_view kind_of(const Group& group) {
  const std::string_view name = group.name;
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

std::string first_and_last(const Column& column) {
  return std::visit(
      [&](const auto& v) {
        return v.empty() ? std::string() : fmt::format("  {:<21} {} to {}\n", column.name, v.front(), v.back());
      },
      column.values);
}

std::string listing(const Result& result, const Group& group) {
  std::size_t rows = 0;
  for (const auto& column : group.columns) rows = std::max(rows, column.rows());
  std::string lines =
      group.columns.empty() ? "/" + group.name : fmt::format("/{:<23} {} x {}", group.name, rows, group.columns.size());
  for (const auto& [name, value] : group.attributes)
    if (name != "scene") lines += fmt::format("  {} = {}", name, text(value));
  lines += '\n';
  const std::string below = group.columns.empty() ? std::string() : quantities(result, group.name);
  if (!below.empty()) lines += fmt::format("  mean, sem, min, max of {}\n", below);
  if (group.name == "series")
    for (const auto& column : group.columns) lines += first_and_last(column);
  return lines;
}

}  // namespace

std::string listing(const Scene& scene, bool all) {
  std::string lines = fmt::format("\nscene{}\n", all ? "" : ", where it differs from the defaults");
  for (const auto& [key, value] : values(scene, all)) lines += fmt::format("  {} = {}\n", key, shortened(value));
  return lines + '\n';
}

std::string listing(const Result& result, const std::string& file, bool all) {
  const Scene scene = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  std::string lines;
  for (const auto& [name, value] : result.attributes)
    if (name != "scene" && (all || value != decltype(value){std::uint64_t{0}}))
      lines += fmt::format("{:<23} {}\n", name, text(value));
  lines += listing(scene, all);
  // Of many tables of one kind the first and the last.
  std::map<std::string_view, std::size_t> of_kind, seen;
  for (const auto& group : result.groups) ++of_kind[kind_of(group)];
  for (const auto& group : result.groups) {
    const std::size_t tables = of_kind[kind_of(group)], k = seen[kind_of(group)]++;
    if (const bool folded = !all && tables > 12; folded && k >= 2 && k + 1 < tables) {
      if (k == 2) lines += fmt::format("... {} more, which --all lists\n", tables - 3);
    } else if (all || !is_detail(group)) {
      lines += listing(result, group);
    }
  }
  return lines;
}

}  // namespace cradle::tools
