#pragma once
// What the engine requires of a number (README.md, Numbers); error-free addition (Knuth's TwoSum, six operations, any
// magnitudes) and the compensated sum built on it.

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "cradle/core/base/fields.hpp"

namespace cradle {

template <class T>
concept Real = std::copyable<T> && std::totally_ordered<T> && std::constructible_from<T, int> &&
    std::constructible_from<T, std::int64_t> && std::numeric_limits<T>::is_specialized &&
    requires(const T a, const T b, T c) {
  { a + b } -> std::convertible_to<T>;
  { a - b } -> std::convertible_to<T>;
  { a* b } -> std::convertible_to<T>;
  { a / b } -> std::convertible_to<T>;
  { -a } -> std::convertible_to<T>;
  c += a;
  c -= a;
  c *= a;
  c /= a;
  { static_cast<double>(a) } -> std::same_as<double>;
};

template <Real T> double to_double(const T& x) { return static_cast<double>(x); }

// Types with a quicker test overload these.
template <Real T> bool is_negative(const T& x) { return x < T(0); }
template <Real T> bool is_positive(const T& x) { return x > T(0); }

template <Real T> T magnitude(const T& x) {
  if constexpr (std::floating_point<T>)
    return std::abs(x);
  else
    return is_negative(x) ? T(-x) : x;
}

// Neither infinite nor NaN: for those x - x is not 0.
template <Real T> bool is_finite(const T& x) { return x - x == T(0); }

// Larger than any length of a scene. Exact types have no largest number; their numeric_limits give 0.
template <Real T> T far_away() {
  const T largest = std::numeric_limits<T>::max();
  return is_positive(largest) ? largest : T(std::numeric_limits<std::int64_t>::max());
}

// Types of exact numbers have no square roots: gravity, shaken walls and wet particles are not for them.
template <Real T> T square_root(const T& x) {
  if constexpr (std::numeric_limits<T>::is_exact) {
    throw std::logic_error("a square root in exact numbers: use another scalar type");
  } else {
    using std::sqrt;
    return sqrt(x);
  }
}

// The double, exactly; a scalar type may have no constructor from double.
template <Real T> T exactly(double x) {
  int exponent = 0;
  T value = T(static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53)));
  for (exponent -= 53; exponent < 0; ++exponent) value /= T(2);
  for (; exponent > 0; --exponent) value *= T(2);
  return value;
}

// 2^exponent x as a double, rounded by a few units, within the range of double (larger numbers become its largest).
// Types with a wider range than double define `double split(x, long& exponent)`: x = mantissa 2^exponent, |mantissa| in
// [1/2, 1] or 0.
inline double scale(double mantissa, long exponent) {
  if (exponent > 1000) return mantissa > 0 ? std::numeric_limits<double>::max() : -std::numeric_limits<double>::max();
  if (exponent < -1000) return 0;
  return mantissa * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// A template, so that doubles, which are queue times themselves, are not converted.
template <std::same_as<long double> T> [[gnu::always_inline]] inline double split(T x, long& exponent) {
  if constexpr (std::numeric_limits<long double>::digits == 64) {  // x87: read the bits, since frexp is a slow call
    std::uint64_t mantissa = 0;
    std::uint16_t sign_and_exponent = 0;
    std::memcpy(&mantissa, &x, sizeof mantissa);
    std::memcpy(&sign_and_exponent, reinterpret_cast<const char*>(&x) + sizeof mantissa, sizeof sign_and_exponent);
    if (mantissa >> 63) {
      exponent = (sign_and_exponent & 0x7FFF) - 16382;
      const double size = static_cast<double>(static_cast<std::int64_t>(mantissa >> 1)) * 0x1p-63;
      return sign_and_exponent >> 15 ? -size : size;
    }
  }
  int e = 0;
  const auto mantissa = static_cast<double>(std::frexp(x, &e));
  exponent = e;
  return mantissa;
}

template <class T>
concept WiderRange = requires(const T x, long exponent) {
  { split(x, exponent) } -> std::same_as<double>;
};
static_assert(WiderRange<long double> && !WiderRange<double> && !WiderRange<float>);

// An unevaluated sum high + low, |low| at most half a unit in the last place of high.
template <Real T> struct Pair {
  T high{0};
  T low{0};

  T value() const { return high + low; }
  static auto state(auto& self) { return fields(self.high, self.low); }
};

// a + b without error in types that round to the nearest number; in double-double exact up to its last digits.
template <Real T> Pair<T> two_sum(const T& a, const T& b) {
  const T sum = a + b;
  const T b_seen = sum - a;
  const T a_seen = sum - b_seen;
  const T error = (a - a_seen) + (b - b_seen);
  return {sum, error};
}

template <Real T> Pair<T> operator+(const Pair<T>& a, const T& b) {
  const Pair<T> sum = two_sum(a.high, b);
  return two_sum(sum.high, T(sum.low + a.low));
}

template <Real T> Pair<T> operator-(const Pair<T>& a, const T& b) { return a + T(-b); }
template <Real T> Pair<T> operator+(const Pair<T>& a, const Pair<T>& b) { return a + b.high + b.low; }
template <Real T> Pair<T> operator-(const Pair<T>& a) { return {T(-a.high), T(-a.low)}; }
template <Real T> Pair<T> operator-(const Pair<T>& a, const Pair<T>& b) { return a + -b; }

// a - b, rounded once if the leading parts cancel, as they do for neighbouring times and positions.
template <Real T> T difference(const Pair<T>& a, const Pair<T>& b) {
  const Pair<T> leading = two_sum(a.high, T(-b.high));
  return leading.high + (leading.low + (a.low - b.low));
}

// Sum of many terms that keeps the rounding error of each addition: its error is about 2 epsilon + n epsilon^2 times
// the sum of magnitudes.
template <Real T> struct CompensatedSum {
  T sum{0};
  T errors{0};

  void add(const T& term) {
    const Pair<T> next = two_sum(sum, term);
    sum = next.high;
    errors += next.low;
  }
  T value() const { return sum + errors; }
  Pair<T> pair() const { return two_sum(sum, errors); }
  static auto state(auto& self) { return fields(self.sum, self.errors); }
};

}  // namespace cradle
