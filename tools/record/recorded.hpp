// Rows of a table as a run has them, in its own type, and what a result file gets of them: doubles, and decimals below
// /exact where the type has more digits.
#pragma once

#include <concepts>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/real.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/record/tables.hpp"

namespace cradle::tools {

template <Real T> T none() { return std::numeric_limits<T>::quiet_NaN(); }

/// Columns of a table, or some of them: numbers of the run's type, and others, which have no more digits than a double.
template <Real T> using Columns = std::vector<std::variant<std::vector<T>, Numbers>>;
template <Real T, class... Values> Columns<T> columns(Values&&... values) {
  Columns<T> all;
  (all.emplace_back(std::forward<Values>(values)), ...);
  return all;
}

template <class Item> void append(std::vector<Item>& all, std::vector<Item>&& more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// Below which those numbers stand that a double does not hold; of doubles there are none.
template <Real T> inline constexpr std::string_view exact_part = std::same_as<T, double> ? "" : exact_folder;

/// Rows of a table as the run has them.
template <Real T> struct Recorded {
  Group table;  // without numbers
  Columns<T> columns;
  std::vector<std::pair<std::string, T>> attributes;
};

/// The same numbers as decimals, all digits of them, below /exact.
template <Real T> Group as_decimals(const Recorded<T>& rows) {
  Group exact{std::string(exact_part<T>) + rows.table.name, {}, {}};
  for (const auto& [name, value] : rows.attributes) exact.attributes.emplace_back(name, to_text(value));
  for (std::size_t k = 0; k < rows.columns.size(); ++k) {
    const auto* values = std::get_if<std::vector<T>>(&rows.columns[k]);
    if (values == nullptr) continue;
    std::vector<std::string> texts;
    for (const T& value : *values) texts.push_back(to_text(value));
    Column& column = exact.columns.emplace_back(rows.table.columns.at(k));
    column.values = std::move(texts);
  }
  return exact;
}

/// Rounded to float64: here, at the last moment.
template <Real T> Group as_doubles(Recorded<T>&& rows) {
  const auto rounded = [](auto& values) -> Numbers {
    if constexpr (std::same_as<std::decay_t<decltype(values)>, Numbers> || std::same_as<T, double>) {
      return std::move(values);
    } else {
      std::vector<double> doubles;
      doubles.reserve(values.size());
      // Types have NaN of either sign.
      for (const T& value : values) doubles.push_back(value == value ? to_double(value) : none<double>());
      return doubles;
    }
  };
  std::vector<Numbers> all;
  for (auto& column : rows.columns) all.push_back(std::visit(rounded, column));
  for (const auto& [name, value] : rows.attributes) rows.table.attributes.emplace_back(name, to_double(value));
  return filled(std::move(rows.table), std::move(all));
}

/// What a result holds of them; `exact`: with decimals where the type has more digits than a double.
template <Real T> std::vector<Group> tables(Recorded<T>&& rows, bool exact) {
  std::vector<Group> all;
  if (!exact_part<T>.empty() && exact) all.push_back(as_decimals(rows));
  all.push_back(as_doubles(std::move(rows)));
  return all;
}

/// What was in it, which is empty afterwards.
template <class Numbers> Numbers taken(Numbers& numbers) { return std::exchange(numbers, Numbers()); }

}  // namespace cradle::tools
