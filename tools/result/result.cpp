#include "cradle/tools/result/result.hpp"

#include <algorithm>
#include <iterator>
#include <type_traits>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

// Keeps the first and the last row.
void keep_ends(Column& column) {
  std::visit(
      [&](auto& values) {
        const auto width = static_cast<std::ptrdiff_t>(column.width);
        const auto rows = static_cast<std::ptrdiff_t>(values.size()) / width;
        if (rows <= 2) return;
        if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<std::string>>)
          for (const std::string& text : values) column.longest = std::max(column.longest, text.size());
        values.erase(values.begin() + width, values.end() - width);
        column.left_out += static_cast<std::uint64_t>(rows - 2);
      },
      column.values);
}

}  // namespace

void GrowingTables::add(Group&& rows) {
  const auto [at, anew] = by_name_.try_emplace(rows.name, tables_.size());
  if (anew) tables_.emplace_back();
  for (const Column& column : rows.columns) numbers_ += column.rows() * column.width;
  std::vector<Column>& columns = tables_[at->second].columns;
  const auto same = [](const Column& a, const Column& b) {
    return a.name == b.name && a.values.index() == b.values.index() && a.width == b.width;
  };
  if (anew)
    tables_.back() = std::move(rows);
  else if (!std::equal(columns.begin(), columns.end(), rows.columns.begin(), rows.columns.end(), same))
    throw Error({{}, 0, rows.name}, "rows of other columns", "", "use the program that wrote them", Exit::io);
  else
    for (std::size_t k = 0; k < columns.size(); ++k)
      std::visit(
          [&]<class Values>(Values& values) {
            auto& more = std::get<Values>(rows.columns[k].values);
            values.insert(values.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
          },
          columns[k].values);
  if (reading_ == Reading::ends) std::for_each(columns.begin(), columns.end(), keep_ends);
}

std::uint64_t numbers_in(const std::vector<Group>& tables) {
  std::uint64_t numbers = 0;
  for (const Group& table : tables)
    for (const Column& column : table.columns) numbers += column.rows() * column.width;
  return numbers;
}

}  // namespace cradle::tools
