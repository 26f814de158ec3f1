// A result in memory: named tables and attributes, in the order in which they are written. All code that writes or
// reads files (files.hpp) uses this form. Its layout is that of result files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// Texts hold decimals with more digits than a float64.
using Numbers = std::variant<std::vector<double>, std::vector<std::uint64_t>, std::vector<std::string>>;

/// One dataset: float64, uint64 or text, with a unit and a line of description. A dataset of width 2 has two numbers
/// per row.
struct Column {
  std::string name;
  std::string unit;
  std::string description;
  Numbers values;              // row after row
  std::size_t width = 1;       // numbers in a row
  bool names = false;          // identifiers, for instance of particles: their mean has no meaning
  std::uint64_t left_out = 0;  // rows of the file, between the first and the last, that were not read
  std::size_t longest = 0;     // bytes of the longest text among these

  std::size_t rows() const {
    return std::visit([](const auto& v) { return v.size(); }, values) / width + left_out;
  }
  /// For complete columns, not those of an outline.
  static auto state(auto& self) { return fields(self.name, self.unit, self.description, self.values, self.width); }
  void loaded() const {
    const std::size_t numbers = std::visit([](const auto& v) { return v.size(); }, values);
    require_state(width > 0 && numbers % width == 0, "rows that are not whole");
  }
};

/// A number for each row: what `of`, a function or a member, gives for it.
template <class Rows, class Of> auto numbers_of(const Rows& rows, Of of) {
  using Given = std::remove_cvref_t<decltype(std::invoke(of, *rows.begin()))>;
  std::vector<std::conditional_t<std::is_integral_v<Given>, std::uint64_t, Given>> numbers;
  numbers.reserve(std::size(rows));
  for (const auto& row : rows) numbers.push_back(std::invoke(of, row));
  return numbers;
}

using Attribute = std::pair<std::string, std::variant<std::string, double, std::uint64_t>>;

/// The attribute of this name; null if it is missing or of another type.
template <class T> const T* find_attribute(const std::vector<Attribute>& attributes, std::string_view name) {
  for (const auto& [key, value] : attributes)
    if (key == name) return std::get_if<T>(&value);
  return nullptr;
}
/// The same. Throws Error (Exit::io), naming `where`, if there is none.
template <class T>
const T& attribute(const std::vector<Attribute>& attributes, std::string_view name, std::string_view where) {
  if (const T* found = find_attribute<T>(attributes, name)) return *found;
  throw Error({std::string(where), 0, ""}, "not a result of this program", "no attribute " + std::string(name),
              "give a file that cradle wrote", Exit::io);
}

/// The first of this name; null if there is none.
template <class Named> const Named* find_named(const std::vector<Named>& all, std::string_view name) {
  const auto at = std::ranges::find(all, name, &Named::name);
  return at == all.end() ? nullptr : &*at;
}

/// "series", "snapshots/0000", ...; a group may hold attributes only.
struct Group {
  std::string name;
  std::vector<Attribute> attributes;
  std::vector<Column> columns;

  const Column* find(std::string_view column) const { return find_named(columns, column); }
  static auto state(auto& self) { return fields(self.name, self.attributes, self.columns); }
};

struct Result {
  std::vector<Attribute> attributes;  // of the file
  std::vector<Group> groups;

  const Group* find(std::string_view name) const { return find_named(groups, name); }
};

/// The folder of decimals: numbers of types wider than double.
inline constexpr std::string_view exact_folder = "exact/";
/// The name of the table that a table of decimals belongs to; other names are returned unchanged.
inline std::string_view rounded_name(std::string_view name) {
  return name.starts_with(exact_folder) ? name.substr(exact_folder.size()) : name;
}

enum class Reading {
  everything,
  ends,  // only the first and the last row of every column
};

/// The tables of a result while it is made: they grow by pieces of rows.
class GrowingTables {
 public:
  /// Keeps all rows of every table, or only the first and the last one and the number between them.
  explicit GrowingTables(Reading reading = Reading::everything) : reading_(reading) {}

  /// Throws Error (Exit::io) if the columns differ from those of the table.
  void add(Group&& rows);
  const std::vector<Group>& tables() const { return tables_; }
  std::vector<Group>& tables() { return tables_; }
  /// The number of numbers that were added.
  std::uint64_t numbers() const { return numbers_; }

 private:
  Reading reading_;
  std::vector<Group> tables_;
  std::uint64_t numbers_ = 0;
  std::unordered_map<std::string, std::size_t> by_name_;
};

/// The number of numbers in tables, including those that were not read.
std::uint64_t numbers_in(const std::vector<Group>& tables);

}  // namespace cradle::tools
