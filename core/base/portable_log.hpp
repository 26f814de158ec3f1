#pragma once
// This logarithm is used for random speeds.

#include <cmath>

namespace cradle::detail {

// ln x for 0 < x <= 1, by the four operations alone: a library's logarithm differs between machines in the last bit.
inline double portable_log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.70710678118654752) mantissa *= 2, --exponent;
  const double s = (mantissa - 1) / (mantissa + 1), square = s * s;  // ln m = 2 artanh s, |s| < 0.172
  double sum = 0;
  for (int k = 23; k > 0; k -= 2) sum = sum * square + 1.0 / k;
  return 2 * s * sum + exponent * 0.693147180559945309;
}

}  // namespace cradle::detail
