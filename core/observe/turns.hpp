#pragma once
// Cosine and sine of angles in turns, by the four operations alone: libraries differ in the last place.
//
// y = n + q/4 + s with whole n and q, |s| <= 1/8, is exact in binary. Then |z| = 2 pi |s| <= pi/4, and the series of
// cos z and sin z are cut where the next term is below 2^-58. The errors are those of z, 1.3e-16, and of rounding the
// results: below 2^-51 for any y that has digits behind the point.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace cradle {

struct UnitVector {
  double cos, sin;
};

namespace detail {

inline constexpr auto inverse_factorials = [] {
  std::array<double, 19> inverse{};
  double factorial = 1;  // exact up to 18!
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    if (n > 0) factorial *= static_cast<double>(n);
    inverse[n] = 1 / factorial;
  }
  return inverse;
}();

}  // namespace detail

inline UnitVector at_turns(double y) {
  const double rest = y - std::floor(y + 0.5), q = std::floor(4 * rest + 0.5);
  const double z = (rest - q / 4) * (2 * std::numbers::pi), x = -z * z;
  double s = detail::inverse_factorials[17], c = detail::inverse_factorials[18];
  for (std::size_t n = 16; n > 1; n -= 2) {
    c = c * x + detail::inverse_factorials[n];
    s = s * x + detail::inverse_factorials[n - 1];
  }
  c = c * x + 1;
  s *= z;
  const bool across = q == 1 || q == -1;
  const double along_cos = across ? s : c, along_sin = across ? c : s;
  return {q == 0 || q == -1 ? along_cos : -along_cos, q == 0 || q == 1 ? along_sin : -along_sin};
}

}  // namespace cradle
