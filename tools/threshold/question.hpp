// What `cradle threshold` asks: a scene, a key of it that varies, and what of a run is compared.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

enum class Compare { collapse, gap, collisions, merges, pair };

struct CompareRow {
  Compare what;
  std::string_view name, text;
};
inline constexpr std::array<CompareRow, 5> compared{{
    {Compare::collapse, "collapse", "whether the run ends at an inelastic collapse that is proved"},
    {Compare::gap, "gap", "whether the run ends at a collapse or at run.stop_gap"},
    {Compare::collisions, "collisions", "number of collisions"},
    {Compare::merges, "merges", "number of merges"},
    {Compare::pair, "pair", "whether the two heavy clusters pass or stick"},
}};

inline constexpr std::string_view no_collapse = "no collapse";

class Question {
 public:
  /// `vary` is KEY=LOW:HIGH or KEY[I]=LOW:HIGH; `compare` a name of the table, empty: what suits the scene. Throws
  /// Error.
  Question(std::string scene, std::vector<std::string> overrides, const std::string& vary, const std::string& compare,
           unsigned digits);

  const std::string& key() const { return key_; }  // with its index
  const Decimal& low() const { return low_; }
  const Decimal& high() const { return high_; }
  bool whole_numbers() const { return whole_; }
  unsigned digits() const { return digits_; }
  const CompareRow& what() const { return compared.at(static_cast<std::size_t>(compare_)); }

  /// The scene with this value. `wide`: in a type of more digits and a larger range than any number needs here; nothing
  /// if there is none beyond the scene's own.
  std::optional<Scene> scene_at(const Decimal& value, bool wide) const;
  /// Whether the scene's own type distinguishes the values.
  bool wide_from_the_start() const { return wide_; }
  /// The outcome as text; nothing if the run has none.
  std::optional<std::string> outcome(const RunOutcome& run) const;
  /// Differs between questions, and between numbers of digits that need runs in other types.
  std::uint64_t identity() const;
  /// What follows `cradle` to ask it again.
  std::string command(const std::string& scene_file) const;

 private:
  std::string assignment(const Decimal& value) const;
  void choose_key(const Scene& given);
  void choose_outcome(const std::string& compare);
  std::uint64_t wide_digits() const { return std::min(std::max(digits_ + 20, 50U), 1000U); }

  std::string scene_, key_, vary_;
  std::vector<std::string> overrides_;
  Scene at_low_;
  Decimal low_, high_;
  unsigned digits_;
  bool whole_ = false, wide_ = false;
  Compare compare_ = Compare::collisions;
  std::vector<std::string> items_;  // of a list; empty for a single number
  std::size_t item_ = 0;
};

}  // namespace cradle::tools
