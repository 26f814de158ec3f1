// Tables with one row for each enumerator.
#pragma once

#include <cstddef>

namespace cradle::tools {

/// Whether the rows are in the order of the enumerators, their `type`, so that these are indices.
constexpr bool rows_in_order(const auto& rows) {
  std::size_t index = 0;
  for (const auto& row : rows)
    if (static_cast<std::size_t>(row.type) != index++) return false;
  return true;
}

}  // namespace cradle::tools
