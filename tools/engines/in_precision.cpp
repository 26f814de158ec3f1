#include "cradle/tools/engines/in_precision.hpp"

#include <fmt/format.h>

#include "cradle/tools/engines/precision.hpp"

namespace cradle::tools {

ScalarChoice scalar_choice(const Run& run) {
  const ScalarRow& type = scalar_row(run.precision);
  return {std::string(type.name), type.digits == 0 ? static_cast<unsigned>(run.digits) : 0};
}

std::string precision_name(const Run& run) {
  const ScalarChoice choice = scalar_choice(run);
  return choice.digits > 0 ? fmt::format("{}, {} digits", choice.name, choice.digits) : choice.name;
}

void set_digits(const Scene& scene) {
  in_precision<void>(scene, [](auto) {});
}

}  // namespace cradle::tools
