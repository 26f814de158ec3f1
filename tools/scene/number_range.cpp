#include "cradle/tools/scene/number_range.hpp"

#include <fmt/format.h>

#include "cradle/tools/scene/fields.hpp"

namespace cradle::tools {

NumberRange::NumberRange(const Run& run) {
  Scene scene;
  scene.run = run;
  precision_ = value_text(*find_field("run.precision", scene), scene).value();
  const ScalarRow& type = scalar_row(run.precision);
  if (type.largest.empty()) return;
  largest_ = type.largest, least_ = type.least;
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
