// A scene while it is checked, with the places of its keys: what the checks of particles and walls
// (checks_of_state.cpp) and of the run and its outputs (checks.cpp) have in common.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/scene/fields.hpp"

namespace cradle::tools {

/// Exact where the decimal has at most 100 digits, and beyond double's range.
inline bin_float precise(const Decimal& decimal) { return from_text<bin_float>(decimal.text); }

struct Checked {
  const Scene& scene;
  const Entries& entries;
  const std::string& scene_file;

  [[noreturn]] void refuse(std::string_view key, std::string_view wrong, std::string_view found,
                           std::string_view advice) const {
    throw Error(place(key), wrong, found, advice);
  }

  void rising(const char* key, const std::vector<Decimal>& range, const char* what, const char* advice) const {
    if (range.size() != 2 || range[0] >= range[1])
      refuse(key, what,
             range.size() == 2 ? fmt::format("from {} to {}", range[0].text, range[1].text)
                               : describe(entries.find(key)->second),
             advice);
  }

  Place place(std::string_view key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? Place{scene_file, 0, std::string(key)} : entry->second.place;
  }

  Place item_place(std::string_view key, std::size_t i) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? place(key) : entry->second.items.at(i).place;
  }

  std::string said(const std::string& key) const {
    return key + " = " + value_text(*find_field(key, scene), scene).value();
  }
};

/// Why the interaction zone of a wet shock has no width; empty: it has one.
std::string without_zone(const Scene& scene);

/// Throws Error for particles and walls that are not possible.
void check_state(const Checked& of);

}  // namespace cradle::tools
