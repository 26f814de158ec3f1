#include "cradle/tools/support/version.hpp"

#include <boost/version.hpp>
#include <type_traits>

#include <fmt/format.h>

#include "cradle/precision/scalars.hpp"

namespace cradle::tools {

std::string build_description() {
  std::string types;
  const auto name = [&]<class T>(std::type_identity<T>) {
    if (types.ends_with(scalar_name<T>)) return;  // all sizes of mpfr have one name
    types.append(types.empty() ? "" : ", ").append(scalar_name<T>);
  };
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    (name(std::type_identity<std::tuple_element_t<K, Scalars>>{}), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Scalars>>{});
#ifdef CRADLE_WITH_MPI
  const char* mpi = "ensembles are spread over ranks";
#else
  const char* mpi = "not in this build";
#endif
  return fmt::format("cradle {}\ncompiler: {}, Boost {}\noptions: {}\nscalar types: {}\nMPI: {}", version, __VERSION__,
                     BOOST_LIB_VERSION, CRADLE_BUILD_OPTIONS, types, mpi);
}

Error of_version(const std::string& path, std::uint64_t found, std::uint64_t here) {
  return {{path, 0, ""},
          fmt::format("a file of {} version of cradle", found < here ? "an earlier" : "a later"),
          fmt::format("format {}, here {}", found, here),
          "read it with the version that wrote it, or remove it and run its scene again",
          Exit::io};
}

}  // namespace cradle::tools
