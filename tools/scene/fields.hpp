// The one table of scene keys. The reader, the effective scene, the manual and the list of keys that differ from their
// defaults use it. A row says where the value is stored; the type of that member is the type of the key.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/scene/source.hpp"

namespace cradle::tools {

template <class T> using Member = T& (*)(Scene&);

using Storage =
    std::variant<Member<std::string>, Member<std::optional<std::string>>, Member<std::vector<std::string>>,
                 Member<Decimal>, Member<std::optional<Decimal>>, Member<std::vector<Decimal>>, Member<DecimalColumn>,
                 Member<std::uint64_t>, Member<std::optional<std::uint64_t>>, Member<bool>, Member<LawType>,
                 Member<InitialType>, Member<scene::HotPlace>, Member<scene::Motion>, Member<Velocities>,
                 Member<Positions>, Member<Precision>, Member<Coordinates>, Member<scene::CollapsePolicy>,
                 Member<Spacing>, Member<scene::Meeting>>;

/// The scenes to which a key applies.
struct Condition {
  std::string_view otherwise;   // what is wrong with the key in other scenes
  std::string_view decided_by;  // the key that decides whether this one applies
  std::string_view text;        // `law.type = "wet"`; empty: every scene
  bool (*holds)(const Scene&);
};

struct Field {
  std::string_view key;  // "law.restitution"
  Storage storage;
  std::string_view unit;      // in m, l (lengths), t (times); "" for pure numbers and texts
  std::string_view fallback;  // TOML; "required"; "" for none; or a description of what `computed` gives
  std::string_view range;     // "[0, 1]", "(0, inf)", "[2, 1e15] even", bounds may be keys; or "a | b | c"
  const Condition* when;
  std::string_view doc;
  std::string (*computed)(const Scene&) = nullptr;
  bool recorded = true;  // in the effective scene; false for keys that cannot change a result
};

/// The rows in an order in which every key comes after the keys that its use, default or range depend on.
std::span<const Field> scene_fields();

/// The row of this key that applies to the scene, else any row of this key, else nullptr.
const Field* find_field(std::string_view key, const Scene& scene);

/// Whether this key takes a list of times, and so a range too.
bool takes_times(const Field& field);

/// "number", "integer", "text", "one of", "list of numbers", "list of texts", "true or false".
std::string_view type_name(const Field& field);

/// Says which values are allowed: `give a number from 0 to 1`. Bounds that are keys are replaced by their values in
/// this scene.
std::string advice(const Field& field, const Scene& scene);

/// Checks type and range, then stores the value. Throws Error at the value's place. Bounds that are keys must be stored
/// before.
void store(const Field& field, const Value& value, Scene& scene);

/// Stores the default; without one the member keeps its value.
void store_default(const Field& field, Scene& scene);

/// Whether two scenes have equal values there: 1.0 is equal to 1.
bool same_value(const Field& field, const Scene& a, const Scene& b);

/// The value in TOML syntax; nothing if there is none.
std::optional<std::string> value_text(const Field& field, const Scene& scene);

/// All numbers stored at this field (none for texts, integers and choices).
std::vector<Decimal> numbers_of(const Field& field, const Scene& scene);

/// A range of times in place of a list is {from, until, every} or {from, until, points, spacing}. Replaces every one by
/// the list of its decimals: from + k every, as exact decimals; or evenly spaced points, or points of equal ratios,
/// with 15 digits, which every double holds. Scenes know lists only. Throws Error at the place of the wrong part.
void expand_time_ranges(Entries& entries);

/// Type, range, unit and default: `number (0, inf), in l, default 1`.
std::string facts(const Field& field);

/// The manual: every key with type, unit, default, range, use and one line of documentation.
std::string describe_fields();

}  // namespace cradle::tools
