// Scene text taken apart: TOML and `--set` assignments become one flat map from dotted keys to values, each with the
// place it stands at. Numbers stay the literals that the user wrote; nothing is known here of what keys mean.
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
  std::string text;          // what a text says; any other scalar as it is written
  std::vector<Value> items;  // of an array
  Place place;
};

/// A value as messages show it: `"wet"`, `1.5`, `an array of 3 values`.
std::string describe(const Value& value);

/// "law.restitution" -> 0.999. Tables appear only where they are empty.
using Entries = std::map<std::string, Value, std::less<>>;

/// Parses TOML; throws Error with file and line where it is none.
Entries read_entries(std::string_view toml, const std::string& source_name);

/// One `table.key=value` on top of what is there: the value in TOML syntax, or else a bare word, which is a text; an
/// empty value takes the key out. A table or array replaces all of the old one.
void apply_override(Entries& entries, std::string_view assignment);

/// A value by itself, in TOML syntax; must be valid.
Value parse_value(std::string_view toml);

}  // namespace cradle::tools
