#include "cradle/tools/support/version.hpp"

#include <boost/version.hpp>

#include <fmt/format.h>

#include "cradle/precision/text.hpp"

namespace cradle::tools {

std::string build_description() {
#ifdef CRADLE_WITH_MPI
  const char* mpi = "ensembles are spread over ranks";
#else
  const char* mpi = "not in this build";
#endif
  return fmt::format("cradle {}\ncompiler: {}, Boost {}\noptions: {}\nscalar types: {}\nMPI: {}", version, __VERSION__,
                     BOOST_LIB_VERSION, CRADLE_BUILD_OPTIONS, scalar_names(), mpi);
}

Error of_version(const std::string& path, std::uint64_t found, std::uint64_t here) {
  return {{path},
          fmt::format("a file of {} version of cradle", found < here ? "an earlier" : "a later"),
          fmt::format("format {}, here {}", found, here),
          "read it with the version that wrote it, or remove it and run its scene again",
          Exit::io};
}

}  // namespace cradle::tools
