#include "cradle/precision/ball_text.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstddef>
#include <cstdio>
#include <ios>

#include "cradle/precision/fixed_point.hpp"

namespace cradle {
namespace {

// Wide enough for the sum of any two doubles and a radius.
using Wide =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<3300, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off>;

// A decimal with so many digits on one side of x: the nearest one or the one after it.
std::string decimal_beside(const Wide& x, int digits, bool below) {
  const auto text = [&](const Wide& number) { return number.str(digits - 1, std::ios_base::scientific); };
  std::string nearest = text(x);
  if (x == 0) return nearest;
  const Wide read(nearest);
  if (below ? read < x : read > x) return nearest;
  const Wide unit = pow(Wide(10), std::stoi(nearest.substr(nearest.find('e') + 1)) - digits + 1);
  return text(below ? Wide(read - unit) : Wide(read + unit));
}

}  // namespace

std::optional<std::string> detail::quick_decimal_beside(const std::array<double, 3>& sum, int digits, bool below) {
  auto exact = FixedPoint::sum({sum[0], sum[1], sum[2]});
  if (!exact) return {};
  const bool negative = exact->is_negative();
  if (negative) exact = -*exact;
  const auto leading = exact->take_leading(static_cast<std::size_t>(digits));
  if (!leading || exact->is_zero() || exact->nearest() == 0.5) return {};
  std::string text = leading->digits;
  if (text.find_first_not_of('0', 1) == text.npos || text.find_first_not_of('9') == text.npos) return {};
  if (below == negative) {
    const auto last = text.find_last_not_of('9');
    ++text[last];
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(last) + 1, text.end(), '0');
  }
  char power_of_ten[16];
  std::snprintf(power_of_ten, sizeof power_of_ten, "e%+03d", leading->exponent);
  return (negative ? "-" : "") + text.insert(1, ".") + power_of_ten;
}

Enclosure<std::string> detail::decimals(const double_double& middle, double radius, int digits) {
  const auto end = [&](double by, bool below) {
    if (auto quick = quick_decimal_beside({middle.high(), middle.low(), by}, digits, below)) return *quick;
    return decimal_beside(Wide(middle.high()) + middle.low() + by, digits, below);
  };
  return {end(-radius, true), end(radius, false)};
}

}  // namespace cradle
