// What a scene must be like. keys.cpp checks that its keys are known and apply to its law, initial state and policy.
// checks_of_state.cpp and checks.cpp check what several keys say together: they refuse rows that do not meet, particles
// out of order, two settings for the same thing, and numbers beyond the range of the working precision.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

/// Makes one entry, a table, of all entries inside what is a key: it is refused where the key is read, when the numbers
/// that its range depends on are known. Ranges of times are lists already.
void gather_tables(Entries& entries);

/// Throws Error for the first unknown key, with the most similar known one.
void refuse_unknown_keys(const Entries& entries);

/// Throws Error for the first key that does not apply to this scene, with the reason. Checks the keys that depend on
/// `decider`, or all keys if it is empty.
void refuse_inapplicable_keys(const Entries& entries, const Scene& scene, std::string_view decider = {});

/// Throws Error at the place of the wrong key. `entries` give the places of keys; `scene_file` names the file for keys
/// that are missing.
void check_scene(const Scene& scene, const Entries& entries, const std::string& scene_file);

/// The numbers that the working precision of a run can hold, beside 0. A larger number would become infinite and spoil
/// the run; a smaller one would become 0.
class NumberRange {
 public:
  explicit NumberRange(const Run& run) : type_(scalar_row(run.precision)) {}

  /// Throws Error at `place` if a canonical decimal is too large or too small.
  void check(std::string_view literal, const Place& place) const;

 private:
  const ScalarRow& type_;
};

/// Throws Error unless particle `right` of a list and the one before it are in order, and apart in the working
/// precision if they are not at one place. Those at one place must not approach: whether one of them collides before
/// with a third one would be open.
void check_neighbours(const DecimalColumn& x, const DecimalColumn& v, std::size_t right, const NumberRange& range,
                      const Place& place);

/// The same of all neighbours; `before` is the place of what is said of a particle and the one before it.
void check_order(const DecimalColumn& x, const DecimalColumn& v, const Run& run,
                 const std::function<Place(std::size_t)>& before);

// ---- what the checks of particles and walls (checks_of_state.cpp) and of the run and its outputs (checks.cpp) share

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
