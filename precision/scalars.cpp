#include "cradle/precision/scalars.hpp"

namespace cradle {

std::string scalar_names() {
  std::string names;
  [&]<class... T>(std::type_identity<std::tuple<T...>>) {
    for (const std::string_view name : {scalar_name<T>...})
      if (!names.ends_with(name)) names.append(names.empty() ? "" : ", ").append(name);  // one of all sizes of mpfr
  }(std::type_identity<Scalars>{});
  return names;
}

}  // namespace cradle
