// Rows of a table in the run's own type, and what a result file stores: doubles and, if the type has more digits,
// decimals below /exact.
#pragma once

#include <concepts>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/base/real.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

/// Puts the numbers into the columns of a table, in order. Throws std::logic_error if their number differs.
Group filled(Group table, std::vector<Numbers> columns);
template <class... Values> Group filled(Group table, Values&&... values) {
  std::vector<Numbers> columns;
  (columns.push_back(Numbers(std::forward<Values>(values))), ...);
  return filled(std::move(table), std::move(columns));
}

template <Real T> T none() { return std::numeric_limits<T>::quiet_NaN(); }

/// A number of any type, for code that is the same for all: the nearest double, and all digits.
struct Number {
  double value = 0;
  std::string text = "0";
};
template <Real T> Number number_of(const T& x) { return {to_double(x), to_text(x)}; }

/// A number that the scene gives, rounded once to the run's type and once to a double.
template <Real T> struct Given {
  T value;
  double rounded;
  std::string text;  // all digits of the type, or the decimal of the scene if that is shorter and another one

  Given(const T& number) : value(number), rounded(to_double(number)), text(to_text(number)) {}
  Given(const T& number, std::string_view decimal) : Given(number) {
    rounded = from_text<double>(decimal);
    if (decimal.size() < text.size() && Decimal(decimal) != Decimal(text)) text = decimal;
  }

  Number number() const { return {rounded, text}; }
  static auto state(auto& self) { return std::tie(self.value, self.rounded, self.text); }
};

/// Columns of a table, or some of them: numbers of the run's type, those that the scene gives, and others that a double
/// holds completely.
template <Real T> using Columns = std::vector<std::variant<std::vector<T>, std::vector<Given<T>>, Numbers>>;
template <Real T, class... Values> Columns<T> columns(Values&&... values) {
  Columns<T> all;
  (all.emplace_back(std::forward<Values>(values)), ...);
  return all;
}

template <class Item> void append(std::vector<Item>& all, std::vector<Item>&& more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// The folder for numbers that a double does not hold completely; doubles have none.
template <Real T> inline constexpr std::string_view exact_part = std::same_as<T, double> ? "" : exact_folder;

/// What the tables are for. A file has the decimals of types wider than a double, and averages that do not cover their
/// whole time; what ends by an interruption is continued later. In numbers for statistics and proofs an interrupted run
/// has its last state instead.
enum class Tables { for_numbers, for_file };

/// Rows of a table in the run's type.
template <Real T> struct Recorded {
  Group table;  // without numbers
  Columns<T> columns;
  std::vector<std::pair<std::string, Given<T>>> attributes;
};

/// The same numbers as decimals with all digits, below /exact.
template <Real T> Group as_decimals(const Recorded<T>& rows) {
  Group exact{std::string(exact_part<T>) + rows.table.name, {}, {}};
  for (const auto& [name, value] : rows.attributes) exact.attributes.emplace_back(name, value.text);
  for (std::size_t k = 0; k < rows.columns.size(); ++k) {
    std::vector<std::string> texts;
    if (const auto* values = std::get_if<std::vector<T>>(&rows.columns[k]))
      for (const T& value : *values) texts.push_back(to_text(value));
    else if (const auto* given = std::get_if<std::vector<Given<T>>>(&rows.columns[k]))
      for (const Given<T>& value : *given) texts.push_back(value.text);
    else
      continue;
    Column& column = exact.columns.emplace_back(rows.table.columns.at(k));
    column.values = std::move(texts);
  }
  return exact;
}

/// Rounds to float64, as the last step.
template <Real T> Group as_doubles(Recorded<T>&& rows) {
  const auto rounded = [](auto& values) -> Numbers {
    using Values = std::decay_t<decltype(values)>;
    if constexpr (std::same_as<Values, Numbers> || std::same_as<Values, std::vector<double>>) {
      return std::move(values);
    } else if constexpr (std::same_as<Values, std::vector<Given<T>>>) {
      std::vector<double> doubles;
      for (const Given<T>& value : values) doubles.push_back(value.rounded);
      return doubles;
    } else {
      std::vector<double> doubles;
      doubles.reserve(values.size());
      // NaN may have either sign here; files get one form.
      for (const T& value : values) doubles.push_back(value == value ? to_double(value) : none<double>());
      return doubles;
    }
  };
  std::vector<Numbers> all;
  for (auto& column : rows.columns) all.push_back(std::visit(rounded, column));
  for (const auto& [name, value] : rows.attributes) rows.table.attributes.emplace_back(name, value.rounded);
  return filled(std::move(rows.table), std::move(all));
}

/// Takes the tables of a run.
class TableSink {
 public:
  explicit TableSink(Tables tables) : tables_(tables) {}
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;
  virtual ~TableSink() = default;

  bool for_file() const { return tables_ == Tables::for_file; }
  /// Appends rows to the table of that name; the columns are those of the table.
  virtual void add(Group&& rows) = 0;
  template <Real T> void add(Recorded<T>&& rows) {
    if (!exact_part<T>.empty() && for_file()) add(as_decimals(rows));
    add(as_doubles(std::move(rows)));
  }

 private:
  Tables tables_;
};

/// Returns the contents and leaves the container empty.
template <class Numbers> Numbers taken(Numbers& numbers) { return std::exchange(numbers, Numbers()); }

}  // namespace cradle::tools
