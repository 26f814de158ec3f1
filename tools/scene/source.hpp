// Splits the text of a scene: TOML and `--set` assignments become one flat map from dotted keys to values, each with
// its place. Numbers remain the literals that the user wrote. The meaning of keys is not known here.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

struct Value {
  enum class Kind { text, number, boolean, date, array, table };
  Kind kind = Kind::text;
  std::string text;          // the contents of a text; other scalars as they are written
  std::vector<Value> items;  // of an array
  Place place;
};

/// The text without blanks and line ends around it.
std::string_view trimmed(std::string_view text);

/// A value as messages show it: `"wet"`, `1.5`, `an array of 3 values`.
std::string describe(const Value& value);

/// "law.restitution" -> 0.999. Tables appear only if they are empty.
using Entries = std::map<std::string, Value, std::less<>>;

/// Parses TOML. Throws Error with file and line if it is not valid.
Entries read_entries(std::string_view toml, const std::string& source_name);

/// The key of an assignment `table.key=value`.
std::string_view key_of(std::string_view assignment);

/// Applies one `table.key=value`: the value is TOML or else a bare word, which is a text; an empty value removes the
/// key. A table or array replaces the old one completely, and so does a key of a table where there was no table.
/// `list[k]=value` replaces one item of a list that is there.
void apply_override(Entries& entries, std::string_view assignment);

/// A single value in TOML syntax, which must be valid.
Value parse_value(std::string_view toml);

}  // namespace cradle::tools
