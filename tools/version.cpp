#include "cradle/tools/version.hpp"

#include <fmt/format.h>

namespace cradle::tools {

std::string build_description() {
  return fmt::format("cradle {}\ncompiler: {}\noptions: {}\nscalar types: double, long double", version, __VERSION__,
                     CRADLE_BUILD_OPTIONS);
}

}  // namespace cradle::tools
