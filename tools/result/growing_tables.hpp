// The tables of a result while it is made: they grow by pieces of rows.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "cradle/tools/result/reader.hpp"

namespace cradle::tools {

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
