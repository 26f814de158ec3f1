#include "cradle/tools/scene/number_range.hpp"

#include <fmt/format.h>

#include "cradle/tools/scene/fields.hpp"

namespace cradle::tools {

NumberRange::NumberRange(const Run& run) {
  Scene scene;
  scene.run = run;
  precision_ = value_text(*find_field("run.precision", scene), scene).value();
  switch (run.precision) {
  case Precision::double_:
  case Precision::double_double:
    largest_ = "1.7976931348623157e308";
    least_ = "2.2250738585072014e-308";
    break;
  case Precision::long_double:
  case Precision::float128:
    largest_ = "1.18973149535723176502e4932";
    least_ = "3.3621031431120935063e-4932";
    break;
  case Precision::cpp_bin_float:  // exponents of 32 bits
    largest_ = "1e323228496";
    least_ = "1e-323228496";
    break;
  case Precision::mpfr:
    return;
  }
  lowest_ = '-' + *largest_;
}

void NumberRange::check(std::string_view literal, const Place& place) const {
  if (!largest_) return;
  if (std::is_lteq(compare_decimals(literal, *largest_)) && std::is_gteq(compare_decimals(literal, *lowest_))) return;
  throw Error(place, "too large for the precision", fmt::format("{} with {}", literal, precision_),
              "give a smaller number or another run.precision");
}

void NumberRange::check_positive(std::string_view literal, const Place& place) const {
  if (!least_ || std::is_gteq(compare_decimals(literal, *least_))) return;
  throw Error(place, "too small for the precision", fmt::format("{} with {}", literal, precision_),
              "give a larger number or another run.precision");
}

}  // namespace cradle::tools
