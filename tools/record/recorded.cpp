#include "cradle/tools/record/recorded.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace cradle::tools {

Group filled(Group table, std::vector<Numbers> columns) {
  if (columns.size() != table.columns.size())
    throw std::logic_error(
        fmt::format("a table /{} of {} columns, and numbers for {}", table.name, table.columns.size(), columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) table.columns[k].values = std::move(columns[k]);
  return table;
}

void TableSink::add(Recorded&& recorded) {
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

}  // namespace cradle::tools
