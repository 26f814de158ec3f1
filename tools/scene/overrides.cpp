#include "cradle/tools/scene/overrides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string_view>

#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/time_range.hpp"

namespace cradle::tools {
namespace {

// If the command line chooses how to sample the series, removes the choice of the file.
void drop_replaced_series(Entries& entries, std::string_view assignment) {
  constexpr std::string_view series = "output.series.";
  const auto key = assignment.substr(0, assignment.find_first_of("= \t"));
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

}  // namespace

std::string apply_overrides(Entries& entries, const std::vector<std::string>& overrides) {
  for (const auto& assignment : overrides) {
    drop_replaced_series(entries, assignment);
    apply_override(entries, assignment);
  }
  expand_time_ranges(entries);
  const auto left_out = drop_times_cut_off(entries);
  if (left_out.empty()) return "";
  return fmt::format("times of the scene outside the run are left out: {}\n", fmt::join(left_out, ", "));
}

}  // namespace cradle::tools
