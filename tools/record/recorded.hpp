// Rows of a table, and what a result file stores: doubles and, if the run's type has more digits, decimals below
// /exact.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// Puts the numbers into the columns of a table, in order. Throws std::logic_error if their number differs.
inline Group filled(Group table, std::vector<Numbers> columns) {
  if (columns.size() != table.columns.size())
    throw std::logic_error(
        fmt::format("a table /{} of {} columns, and numbers for {}", table.name, table.columns.size(), columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) table.columns[k].values = std::move(columns[k]);
  return table;
}
template <class... Values> Group filled(Group table, Values&&... values) {
  std::vector<Numbers> columns;
  (columns.push_back(Numbers(std::forward<Values>(values))), ...);
  return filled(std::move(table), std::move(columns));
}

/// Numbers of the run's type, with their texts if these are wanted.
struct NumberColumn {
  std::vector<double> values;
  std::optional<std::vector<std::string>> texts;

  explicit NumberColumn(bool exact) {
    if (exact) texts.emplace();
  }
  void push_back(const Number& x) {
    values.push_back(x.value);
    if (texts) texts->push_back(x.text());
  }
};

/// Columns of a table, or some of them: numbers of the run's type, and others that a double holds completely.
using Columns = std::vector<std::variant<NumberColumn, Numbers>>;
template <class... Values> Columns columns(Values&&... values) {
  Columns all;
  (all.emplace_back(std::forward<Values>(values)), ...);
  return all;
}

template <class Item> void append(std::vector<Item>& all, std::vector<Item>&& more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// What the tables are for. A file has the decimals of types wider than a double, and averages that do not cover their
/// whole time; what ends by an interruption is continued later. In numbers for proofs an interrupted run has its last
/// state instead. Statistics take what is measured at planned times, and no texts.
enum class Tables { for_numbers, for_file, for_statistics };

struct Recorded {
  Group table;  // without numbers
  Columns columns;
  std::vector<std::pair<std::string, Number>> attributes;
};

/// Takes the tables of a run.
class TableSink {
 public:
  explicit TableSink(Tables tables) : tables_(tables) {}
  TableSink& operator=(TableSink&&) = delete;
  virtual ~TableSink() = default;

  bool for_file() const { return tables_ == Tables::for_file; }
  bool for_statistics() const { return tables_ == Tables::for_statistics; }
  /// Appends rows to the table of that name; the columns are those of the table.
  virtual void add(Group&& rows) = 0;
  /// And, if the columns have texts, to that of the decimals.
  void add(Recorded&& recorded) {
    Group exact{std::string(exact_folder) + recorded.table.name, {}, {}};
    std::vector<Numbers> doubles;
    for (std::size_t k = 0; k < recorded.columns.size(); ++k) {
      auto* numbers = std::get_if<NumberColumn>(&recorded.columns[k]);
      if (numbers != nullptr && numbers->texts)
        exact.columns.emplace_back(recorded.table.columns.at(k)).values = std::move(*numbers->texts);
      doubles.push_back(numbers != nullptr ? Numbers(std::move(numbers->values))
                                           : std::get<Numbers>(std::move(recorded.columns[k])));
    }
    for (const auto& [name, x] : recorded.attributes) {
      if (!exact.columns.empty()) exact.attributes.emplace_back(name, x.text());
      recorded.table.attributes.emplace_back(name, x.value);
    }
    if (!exact.columns.empty()) add(std::move(exact));
    add(filled(std::move(recorded.table), std::move(doubles)));
  }
  /// Statistics take the rows of the series as they are, and empty them; others get a table of them (false).
  virtual bool take_series(std::vector<NumberColumn>&) { return false; }

 private:
  Tables tables_;
};

/// Returns the contents and leaves the container empty.
template <class Numbers> Numbers taken(Numbers& numbers) { return std::exchange(numbers, Numbers()); }
inline NumberColumn taken(NumberColumn& column) {
  return std::exchange(column, NumberColumn(column.texts.has_value()));
}

}  // namespace cradle::tools
