// Handles one value and its row of the table: checks type and range, stores it, writes it back. Differences between the
// types of keys are here, one overload per type of member. Nothing here depends on a particular key.
#include "cradle/tools/scene/fields.hpp"

#include <algorithm>
#include <cctype>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cradle::tools {
namespace {

constexpr std::string_view not_finite[] = {"inf", "+inf", "-inf", "nan", "+nan", "-nan"};

template <class T> constexpr bool is_optional = false;
template <class T> constexpr bool is_optional<std::optional<T>> = true;

// The parts of "[0, 0.5) even".
struct Interval {
  std::string lower, upper;
  bool lower_open = false, upper_open = false, even = false;
};

Interval interval_of(const Field& field) {
  const std::string_view text = field.range;
  const auto comma = text.find(", ");
  const auto close = text.find_first_of(")]");
  return {std::string(text.substr(1, comma - 1)), std::string(text.substr(comma + 2, close - comma - 2)),
          text.front() == '(', text[close] == ')', text.ends_with(" even")};
}

// A bound is a number, "inf" or a key whose value is the bound.
bool is_key(std::string_view bound) {
  return bound != "inf" && std::isalpha(static_cast<unsigned char>(bound.front())) != 0;
}

std::string bound_value(const std::string& bound, const Scene& scene) {
  return is_key(bound) ? value_text(*find_field(bound, scene), scene).value() : bound;
}

std::string bound_words(const std::string& bound, const Scene& scene) {
  return is_key(bound) ? bound + " = " + bound_value(bound, scene) : bound;
}

std::string range_words(const Interval& range, const Scene& scene) {
  const auto lower = bound_words(range.lower, scene);
  const auto upper = bound_words(range.upper, scene);
  if (range.upper == "inf") {
    if (range.lower == "-inf") return "";
    return range.lower_open ? " above " + lower : " of " + lower + " or more";
  }
  return fmt::format(" from {}{} to {}{}", range.lower_open ? "above " : "", lower, range.upper_open ? "below " : "",
                     upper);
}

bool within(const Interval& range, const std::string& number, const Scene& scene) {
  if (range.lower != "-inf") {
    const auto order = compare_decimals(number, bound_value(range.lower, scene));
    if (range.lower_open ? std::is_lteq(order) : std::is_lt(order)) return false;
  }
  if (range.upper == "inf") return true;
  const auto order = compare_decimals(number, bound_value(range.upper, scene));
  return range.upper_open ? std::is_lt(order) : std::is_lteq(order);
}

std::vector<std::string_view> choices_of(const Field& field) {
  std::vector<std::string_view> names;
  for (std::string_view rest = field.range; !rest.empty();) {
    const auto bar = rest.find(" | ");
    names.push_back(rest.substr(0, bar));
    rest = bar == rest.npos ? std::string_view() : rest.substr(bar + 3);
  }
  return names;
}

// Shows numbers without quotation marks.
[[noreturn]] void refuse(const Field& field, const Value& value, const Scene& scene, std::string_view wrong) {
  throw Error(value.place, wrong, canonical_decimal(value.text) ? excerpt(value.text) : describe(value),
              advice(field, scene));
}

// The literal of a number within its range, quoted or not.
std::string number_text(const Field& field, const Value& value, const Scene& scene) {
  if (std::ranges::find(not_finite, value.text) != std::end(not_finite)) refuse(field, value, scene, "not finite");
  if (value.kind != Value::Kind::number && value.kind != Value::Kind::text) refuse(field, value, scene, "wrong type");
  const auto number = canonical_decimal(value.text);
  if (!number) refuse(field, value, scene, value.kind == Value::Kind::text ? "wrong type" : "not a decimal number");
  if (!within(interval_of(field), *number, scene)) refuse(field, value, scene, "out of range");
  return *number;
}

void read(const Field& field, const Value& value, Scene& scene, std::string& target) {
  // In `--set title=2026` any bare word is a text.
  const bool bare = value.place.source == "--set" && value.kind != Value::Kind::array;
  if (value.kind != Value::Kind::text && !(bare && !value.text.empty())) refuse(field, value, scene, "wrong type");
  if (value.text.find('\0') != value.text.npos) refuse(field, value, scene, "a text with a character 0");
  target = value.text;
}

void read(const Field& field, const Value& value, Scene& scene, Decimal& target) {
  target = Decimal(number_text(field, value, scene));
}

void read(const Field& field, const Value& value, Scene& scene, std::uint64_t& target) {
  const auto number = number_text(field, value, scene);
  if (!is_whole(number)) refuse(field, value, scene, "not an integer");
  target = decimal_integer(number).value();  // the range is within 64 bits
  if (interval_of(field).even && target % 2 != 0) refuse(field, value, scene, "odd");
}

void read(const Field& field, const Value& value, Scene& scene, bool& target) {
  if (value.kind != Value::Kind::boolean) refuse(field, value, scene, "wrong type");
  target = value.text == "true";
}

// The place of a text among the choices of the field.
std::size_t choice(const Field& field, const Value& value, const Scene& scene) {
  if (value.kind != Value::Kind::text) refuse(field, value, scene, "wrong type");
  const auto names = choices_of(field);
  const auto found = std::ranges::find(names, value.text);
  if (found == names.end() && !names.empty()) refuse(field, value, scene, "no such choice");
  return static_cast<std::size_t>(found - names.begin());
}

template <class List>
requires requires(const List& list) { list.back(); }
void read(const Field& field, const Value& value, Scene& scene, List& target) {
  if (value.kind != Value::Kind::array && type_name(field) == "list of texts" && value.place.source == "--set") {
    const auto names = choices_of(field);
    throw Error(value.place, "wrong type", describe(value),
                fmt::format("{}, in quotes: --set '{}=[\"{}\"]'", advice(field, scene), field.key,
                            names.empty() ? "..." : names.front()));
  }
  if (value.kind != Value::Kind::array) refuse(field, value, scene, "wrong type");
  target = {};
  for (const Value& item : value.items) {
    if constexpr (std::is_same_v<List, std::vector<std::string>>)
      choice(field, item, scene), target.push_back(item.text);
    else if constexpr (std::is_same_v<List, DecimalColumn>)
      target.push_back(number_text(field, item, scene));
    else
      target.emplace_back(number_text(field, item, scene));
  }
}

template <class E>
requires std::is_enum_v<E>
void read(const Field& field, const Value& value, Scene& scene, E& target) {
  target = static_cast<E>(choice(field, value, scene));
}

template <class T> void read(const Field& field, const Value& value, Scene& scene, std::optional<T>& target) {
  T inner{};
  read(field, value, scene, inner);
  target = std::move(inner);
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result.append(1, '\\').append(1, c);
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::optional<std::string> written(const Field&, const std::string& value) { return in_quotes(value); }
std::optional<std::string> written(const Field&, const Decimal& value) { return value.text; }
std::optional<std::string> written(const Field&, const std::uint64_t& value) {
  // TOML integers are at most 2^63 - 1.
  const auto text = std::to_string(value);
  return value >> 63U == 0 ? text : in_quotes(text);
}
std::optional<std::string> written(const Field&, const bool& value) { return value ? "true" : "false"; }

std::string_view item_text(std::string_view decimal) { return decimal; }
std::string_view item_text(const Decimal& decimal) { return decimal.text; }
std::string item_text(const std::string& text) { return in_quotes(text); }
template <class List>
requires requires(const List& list) { item_text(list[0]); }
std::optional<std::string> written(const Field& field, const List& list) {
  if (list.empty() && field.fallback.empty()) return {};
  std::string text = "[";
  for (std::size_t i = 0; i < list.size(); ++i) text.append(i == 0 ? "" : ", ").append(item_text(list[i]));
  return text + ']';
}
template <class E>
requires std::is_enum_v<E> std::optional<std::string> written(const Field& field, const E& value) {
  return in_quotes(choices_of(field).at(static_cast<std::size_t>(value)));
}
template <class T> std::optional<std::string> written(const Field& field, const std::optional<T>& value) {
  return value ? written(field, *value) : std::nullopt;
}

template <class T> std::string_view name_of_type() {
  if constexpr (is_optional<T>) return name_of_type<typename T::value_type>();
  if constexpr (std::is_same_v<T, std::string>) return "text";
  if constexpr (std::is_same_v<T, Decimal>) return "number";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "integer";
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_same_v<T, std::vector<Decimal>> || std::is_same_v<T, DecimalColumn>) return "list of numbers";
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return "list of texts";
  return "one of";
}

// Accessors only form a reference, so it is safe to read a constant scene through them.
template <class T> const T& member_of(Member<T> access, const Scene& scene) {
  return access(const_cast<Scene&>(scene));
}

}  // namespace

std::string_view type_name(const Field& field) {
  return std::visit([]<class T>(Member<T>) { return name_of_type<T>(); }, field.storage);
}

std::string advice(const Field& field, const Scene& scene) {
  const auto type = type_name(field);
  if (type == "true or false") return "give true or false";
  if (type == "text") return "give a text";
  if (type == "list of texts")
    return field.range.empty() ? "give a list of texts"
                               : fmt::format("give a list of {}", fmt::join(choices_of(field), ", "));
  if (type == "one of") return fmt::format("give one of {}", fmt::join(choices_of(field), ", "));
  const Interval range = interval_of(field);
  const auto words = range_words(range, scene);
  if (takes_times(field)) return fmt::format("give a list of numbers{}, or a table {{from, until, every}}", words);
  if (type == "list of numbers") return "give a list of numbers" + words;
  return fmt::format("give {} {}{}", range.even || type == "integer" ? "an" : "a", range.even ? "even integer" : type,
                     words);
}

void store(const Field& field, const Value& value, Scene& scene) {
  std::visit([&](auto access) { read(field, value, scene, access(scene)); }, field.storage);
}

void store_default(const Field& field, Scene& scene) {
  if (field.computed != nullptr) {
    store(field, parse_value(field.computed(scene)), scene);
  } else if (!field.fallback.empty() && field.fallback != "required") {
    store(field, parse_value(field.fallback), scene);
  }
}

bool same_value(const Field& field, const Scene& a, const Scene& b) {
  return std::visit([&]<class T>(Member<T> access) { return member_of(access, a) == member_of(access, b); },
                    field.storage);
}

std::optional<std::string> value_text(const Field& field, const Scene& scene) {
  return std::visit([&]<class T>(Member<T> access) { return written(field, member_of(access, scene)); }, field.storage);
}

std::vector<Decimal> numbers_of(const Field& field, const Scene& scene) {
  const auto numbers = [&]<class T>(Member<T> access) -> std::vector<Decimal> {
    const T& value = member_of(access, scene);
    if constexpr (std::is_same_v<T, Decimal>) return {value};
    if constexpr (std::is_same_v<T, std::vector<Decimal>>) return value;
    std::vector<Decimal> all;
    if constexpr (std::is_same_v<T, DecimalColumn>)
      for (std::size_t i = 0; i < value.size(); ++i) all.emplace_back(value[i]);
    if constexpr (std::is_same_v<T, std::optional<Decimal>>)
      if (value) all.push_back(*value);
    return all;
  };
  return std::visit(numbers, field.storage);
}

}  // namespace cradle::tools
