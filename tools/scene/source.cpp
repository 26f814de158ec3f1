// toml++ parses and reports where each value begins; literals are taken from the text at that place.
#include "cradle/tools/scene/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include <toml++/toml.h>

#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view literal_characters = "0123456789abcdefABCDEFinoxINOX_+-.";
constexpr std::string_view decimal_characters = "0123456789+-_.eE";
constexpr std::ptrdiff_t most_parts = 16;  // of a key: toml++ and what follows recurse for each

// The end of the comment or string that begins at `i`; `i` if none begins there.
std::size_t skip_comment_or_string(std::string_view text, std::size_t i) {
  if (text[i] == '#') return std::min(text.find('\n', i), text.size());
  if (text[i] != '"' && text[i] != '\'') return i;
  const char quote = text[i];
  const bool multiline = text.substr(i, 3) == std::string(3, quote);
  const std::string close(multiline ? 3 : 1, quote);
  for (std::size_t j = i + close.size(); j < text.size(); ++j) {
    if (quote == '"' && text[j] == '\\') {
      ++j;
    } else if (text.substr(j, close.size()) == close) {
      return j + close.size();
    } else if (text[j] == '\n' && !multiline) {
      return j;  // unterminated: toml++ reports it
    }
  }
  return text.size();
}

// Whether it is a decimal number in TOML: the canonical form, which has digits on both sides of a point and no zeros
// before others, leaves out underscores and signs + only.
bool is_toml_number(std::string_view text) {
  std::string plain(text);
  std::erase_if(plain, [](char c) { return c == '_' || c == '+'; });
  std::ranges::replace(plain, 'E', 'e');
  return canonical_decimal(text) == plain;
}

// toml++ refuses numbers beyond int64, the range of double or its buffer. This puts them in quotation marks, which
// changes columns but not lines. A literal is text at the place of a value that is not followed by '='. Throws
// toml::parse_error for a key of too many parts.
std::string quote_wide_literals(std::string_view text) {
  std::string result;
  char before = '\n';  // the last non-blank character
  std::ptrdiff_t points = 0;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = skip_comment_or_string(text, i);
    if (end > i) {
      result += text.substr(i, end - i);
      if (text[i] != '#') before = '"';
      i = end;
      continue;
    }
    end = std::min(text.find_first_not_of(decimal_characters, i), text.size());
    const auto literal = text.substr(i, end - i);
    points += std::ranges::count(literal, '.');
    if (points >= most_parts) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
      throw toml::parse_error("a key of more than 16 parts", toml::source_position{static_cast<unsigned>(line), 1});
    }
    if (literal.empty()) {
      if (std::string_view("=,[]{}\n").find(text[i]) != text.npos) points = 0;
      if (blanks.find(text[i]) == blanks.npos) before = text[i];
      result += text[i++];
      continue;
    }
    const auto after = text.find_first_not_of(" \t", end);
    const bool is_value = (before == '=' || before == '[' || before == ',') &&
                          (after == text.npos || std::string_view(",]}#\r\n").find(text[after]) != text.npos);
    const auto exponent = literal.find_first_of("eE");
    const bool wide = literal.size() > 15 || (exponent != literal.npos && literal.size() - exponent > 3);
    if (is_value && wide && is_toml_number(literal)) {
      result.append("\x22").append(literal).append("\x22");
    } else {
      result += literal;
    }
    before = literal.back();
    i = end;
  }
  return result;
}

// Finds literals by toml++'s line and column (both from 1, columns in code points).
class Literals {
 public:
  explicit Literals(std::string_view text) : text_(text) {
    lines_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') lines_.push_back(i + 1);
  }

  std::string at(const toml::source_position& begin) const {
    // The values of a list stand one after the other, often in one long line.
    if (begin.line != last_.line || begin.column < last_.column)
      last_ = {begin.line, 1}, i_ = lines_.at(begin.line - 1);
    for (; last_.column < begin.column; ++last_.column) {
      ++i_;
      while (i_ < text_.size() && (static_cast<unsigned char>(text_[i_]) & 0xC0U) == 0x80U) ++i_;
    }
    const std::size_t i = std::min(i_, text_.size());
    const auto end = std::min(text_.find_first_not_of(literal_characters, i), text_.size());
    return std::string(text_.substr(i, end - i));
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> lines_;
  // The place of the literal that was found last.
  mutable toml::source_position last_{0, 1};
  mutable std::size_t i_ = 0;
};

Value value_of(const toml::node& node, const Literals& literals, const Place& place) {
  Value value;
  value.place = place;
  value.place.line = node.source().begin.line;
  if (const auto* text = node.as_string()) {
    value.text = text->get();
  } else if (const auto* truth = node.as_boolean()) {
    value.kind = Value::Kind::boolean;
    value.text = truth->get() ? "true" : "false";
  } else if (node.is_number()) {
    value.kind = Value::Kind::number;
    value.text = literals.at(node.source().begin);
    // Hexadecimal, octal and binary numbers are always small here.
    if (value.text.size() > 1 && std::string_view("xob").find(value.text[1]) != std::string_view::npos)
      value.text = std::to_string(node.as_integer()->get());
  } else if (const auto* array = node.as_array()) {
    value.kind = Value::Kind::array;
    for (const auto& item : *array) value.items.push_back(value_of(item, literals, place));
  } else {
    value.kind = node.is_table() ? Value::Kind::table : Value::Kind::date;
  }
  return value;
}

// A table without keys is a value, unless it is the whole text.
void flatten(const toml::node& node, const Literals& literals, const Place& place, Entries& entries) {
  const auto* table = node.as_table();
  if (table == nullptr || (table->empty() && !place.key.empty())) {
    entries.insert_or_assign(place.key, value_of(node, literals, place));
    return;
  }
  for (const auto& [name, below] : *table) {
    Place inner = place;
    if (!inner.key.empty()) inner.key += '.';
    inner.key += name.str();
    flatten(below, literals, inner, entries);
  }
}

// The entries of `value = TEXT`, under `key`; nothing if TEXT is not TOML.
std::optional<Entries> assigned(std::string_view text, const Place& place) {
  try {
    const std::string document = quote_wide_literals("value = " + std::string(text));
    const toml::table table = toml::parse(document);
    if (table.size() != 1) return {};  // TEXT had a line end and a second key
    const Literals literals(document);
    Entries entries;
    flatten(*table.get("value"), literals, place, entries);
    for (auto& [key, value] : entries) {
      value.place.line = 0;
      for (auto& item : value.items) item.place.line = 0;
    }
    return entries;
  } catch (const toml::parse_error&) {
    return {};
  }
}

// One item of a list that the scene has: `initial.m[1]=50`.
void replace_item(Entries& entries, const Place& place, std::string_view text) {
  const auto bracket = place.key.find('[');
  const std::string array = place.key.substr(0, bracket);
  const auto entry = entries.find(array);
  if (bracket == place.key.npos || entry == entries.end() || entry->second.kind != Value::Kind::array)
    throw Error(place, "not an item of a list in the scene",
                entry == entries.end() ? "no " + array : describe(entry->second), "give the whole list, " + array);
  std::vector<Value>& items = entry->second.items;
  const std::string index = place.key.substr(bracket + 1, place.key.size() - bracket - 2);
  std::size_t k = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), k);
  if (error != std::errc() || end != index.data() + index.size() || k >= items.size())
    throw Error(place, "not an item of the list", describe(entry->second),
                items.empty() ? "give the whole list, " + array
                              : fmt::format("give {0}[0] to {0}[{1}]", array, items.size() - 1));
  auto given = assigned(text, place);
  items[k] = given ? std::move(given->begin()->second) : Value{Value::Kind::text, std::string(text), {}, place};
  items[k].place = {place.source, 0, array};
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::string describe(const Value& value) {
  switch (value.kind) {
  case Value::Kind::text:
    return '"' + excerpt(value.text) + '"';
  case Value::Kind::array:
    return fmt::format("an array of {} value{}", value.items.size(), value.items.size() == 1 ? "" : "s");
  case Value::Kind::table:
    return "a table";
  case Value::Kind::date:
    return "a date or time";
  default:
    return excerpt(value.text);
  }
}

Entries read_entries(std::string_view toml, const std::string& source_name) {
  if (toml.starts_with("\xEF\xBB\xBF")) toml.remove_prefix(3);  // byte order mark
  try {
    const std::string document = quote_wide_literals(toml);
    const toml::table table = toml::parse(document);
    Entries entries;
    flatten(table, Literals(document), Place{source_name}, entries);
    return entries;
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    if (const std::string_view noise = "Error while parsing "; what.starts_with(noise))
      what.remove_prefix(noise.size());
    throw Error({source_name, error.source().begin.line, {}}, "not valid TOML", what,
                "correct this line or the one before it");
  }
}

std::string_view key_of(std::string_view assignment) { return trimmed(assignment.substr(0, assignment.find('='))); }

void apply_override(Entries& entries, std::string_view assignment) {
  const auto equals = assignment.find('=');
  const std::string key(key_of(assignment));
  if (equals == assignment.npos || key.empty())
    throw Error({"--set", 0, {}}, "not an assignment", assignment, "write table.key=value");
  const Place place{"--set", 0, key};
  const auto text = trimmed(assignment.substr(equals + 1));
  if (key.ends_with(']')) return replace_item(entries, place, text);

  const auto inside = [](const std::string& inner, const std::string& outer) { return inner.starts_with(outer + '.'); };
  std::erase_if(entries, [&](const auto& entry) {
    return entry.first == key || inside(entry.first, key) || inside(key, entry.first);
  });
  if (text.empty()) return;
  if (auto parsed = assigned(text, place)) {
    entries.merge(*parsed);
  } else {
    entries.emplace(key, Value{Value::Kind::text, std::string(text), {}, place});
  }
}

Value parse_value(std::string_view toml) { return assigned(toml, {}).value().begin()->second; }

}  // namespace cradle::tools
