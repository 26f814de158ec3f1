#include "cradle/tools/scene/particle_order.hpp"

#include <fmt/format.h>

#include <compare>

namespace cradle::tools {

void NumberRange::check(std::string_view literal, const Place& place) const {
  const auto size = literal.substr(literal.starts_with('-') ? 1 : 0);
  if (type_.largest.empty() || std::is_lteq(compare_decimals(size, type_.largest))) return;
  throw Error(place, "too large for the precision", fmt::format("{} with \"{}\"", literal, type_.name),
              "give a smaller number or another run.precision");
}

void NumberRange::check_positive(std::string_view literal, const Place& place) const {
  if (type_.least.empty() || std::is_gteq(compare_decimals(literal, type_.least))) return;
  throw Error(place, "too small for the precision", fmt::format("{} with \"{}\"", literal, type_.name),
              "give a larger number or another run.precision");
}

void check_neighbours(const DecimalColumn& x, const DecimalColumn& v, std::size_t right, const NumberRange& range,
                      const Place& place) {
  const std::size_t left = right - 1;
  const auto order = compare_decimals(x[right], x[left]);
  if (std::is_gt(order)) return range.check_positive(difference(x[right], x[left]), place);
  const auto places = fmt::format("{} after {}", x[right], x[left]);
  if (std::is_lt(order)) throw Error(place, "not increasing", places, "give the particles in order of increasing x");
  if (std::is_gt(compare_decimals(v[left], v[right])))
    throw Error(place, "particles that touch and approach", places,
                "give them the velocities that they have after this collision, or a distance: initial.gap, or a column "
                "gap, with 1e-300 there");
}

void check_order(const DecimalColumn& x, const DecimalColumn& v, const Run& run,
                 const std::function<Place(std::size_t)>& before) {
  const NumberRange range(run);
  for (std::size_t right = 1; right < x.size(); ++right) check_neighbours(x, v, right, range, before(right));
}

}  // namespace cradle::tools
