#include "cradle/precision/scalars.hpp"

#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

namespace cradle {

std::string scalar_names() {
  std::string names;
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    for (const std::string_view name : {scalar_name<std::tuple_element_t<K, Scalars>>...})
      if (!names.ends_with(name)) names.append(names.empty() ? "" : ", ").append(name);  // one of all sizes of mpfr
  }
  (std::make_index_sequence<std::tuple_size_v<Scalars>>{});
  return names;
}

}  // namespace cradle
