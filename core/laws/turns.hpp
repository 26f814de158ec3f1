#pragma once
// Cosine and sine of angles in turns, by the four operations alone, in any scalar type: libraries differ in the last
// place.
//
// y = n + q/4 + s with whole n and q, |s| <= 1/8, is exact in binary. Then |z| = 2 pi |s| <= pi/4, and the series of
// cos z and sin z are cut where the next term is below 1/64 of the type's epsilon. The errors are those of z, a unit
// roundoff, and of rounding the results: in double below 2^-51 for any y that has digits behind the point.
//
// pi is that of Machin's formula, pi/4 = 4 atan(1/5) - atan(1/239), as a sum of two numbers.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "cradle/core/laws/approach.hpp"

namespace cradle {

template <Real T = double> struct UnitVector { T cos, sin; };

// The whole number nearest to y, which is in the range of double; of two the larger one.
template <Real T> T nearest_whole(const T& y) {
  T whole(0), rest = y;
  double leading = to_double(rest);
  for (; std::isfinite(leading) && !(std::abs(leading) < 0x1p53); leading = to_double(rest)) {  // it is whole
    const T part = exactly<T>(leading);
    whole += part, rest -= part;
  }
  if (!std::isfinite(leading)) return y;
  const T n = T(static_cast<std::int64_t>(std::floor(leading + 0.5)));
  const T beyond = (rest - n) + (rest - n);  // to double, it may be rounded to the middle between two
  return whole + (beyond < T(-1) ? T(n - T(1)) : beyond < T(1) ? n : T(n + T(1)));
}
inline double nearest_whole(double y) { return std::floor(y + 0.5); }

namespace detail {

// 1/0!, 1/1!, ..., 1/n!, n even.
inline constexpr auto inverse_factorials = [] {
  std::array<double, 19> inverse{};
  double factorial = 1;  // exact up to 18!
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    if (n > 0) factorial *= static_cast<double>(n);
    inverse[n] = 1 / factorial;
  }
  return inverse;
}();

// The series of the angle z, x = -z^2: (cos z - 1)/x and (sin z - z)/(x z).
template <class T, class Inverses> UnitVector<T> series(const T& x, const Inverses& inverse) {
  std::size_t n = inverse.size() - 1;
  T c = inverse[n], s = inverse[n - 1];
  for (n -= 2; n > 2; n -= 2) {
    c = c * x + inverse[n];
    s = s * x + inverse[n - 1];
  }
  return {T(c * x + inverse[2]), s};
}

template <class T, class Inverses> UnitVector<T> at_turns(const T& y, const T& full_turn, const Inverses& inverse) {
  T rest = y;
  if (!(magnitude(y) < T(1) / T(2))) [[unlikely]]
    rest -= nearest_whole(y);
  const T q = nearest_whole(T(T(4) * rest));
  const T z = (rest - q / T(4)) * full_turn, x = -z * z;
  const UnitVector<T> of = series(x, inverse);
  const T c = of.cos * x + T(1), s = (of.sin * x + T(1)) * z;
  const bool across = magnitude(q) == T(1), to_right = q == T(0) || q == T(-1), up = q == T(0) || q == T(1);
  const T along_cos = across ? s : c, along_sin = across ? c : s;
  return {to_right ? along_cos : T(-along_cos), up ? along_sin : T(-along_sin)};
}

}  // namespace detail

inline UnitVector<double> at_turns(double y) {
  return detail::at_turns(y, 2 * std::numbers::pi, detail::inverse_factorials);
}

// a/b, with twice the digits in types that round to the nearest.
template <Real T> Pair<T> quotient(const Pair<T>& a, const Pair<T>& b) {
  const T q = a.high / b.high;
  if constexpr (RoundsToNearest<T>) {
    const Pair<T> rest = a - exact_product(q, b.high, splitter<T>()) - T(q * b.low);
    return two_sum(q, T(rest.value() / b.high));
  } else {
    return {q, T(0)};
  }
}

// 2 pi.
template <Real T> Pair<T> full_turn() {
  const T epsilon = std::numeric_limits<T>::epsilon();
  const auto atan_of_inverse = [&](int n) {
    Pair<T> power = quotient(Pair<T>{T(1), T(0)}, Pair<T>{T(n), T(0)}), sum = power;
    for (int k = 3; magnitude(power.high) > epsilon * epsilon; k += 2) {
      power = quotient(power, Pair<T>{T(-n * n), T(0)});
      sum = sum + quotient(power, Pair<T>{T(k), T(0)});
    }
    return sum;
  };
  const Pair<T> fifth = atan_of_inverse(5), other = atan_of_inverse(239);
  Pair<T> pi{T(0), T(0)};
  for (int k = 0; k < 16; ++k) pi = pi + fifth;
  for (int k = 0; k < 4; ++k) pi = pi - other;
  return pi + pi;
}

// In any type; tables are made once.
template <Real T> class Circle {
 public:
  Circle() : full_turn_(cradle::full_turn<T>()), turn_(full_turn_.value()) {
    const T least = T(std::numeric_limits<T>::epsilon()) / T(64);
    T factorial(1), term(1);
    for (int n = 0; n % 2 != 1 || term > least; ++n) {  // the last n is even
      if (n > 0) factorial *= T(n), term *= T(4) / T(5 * n);
      inverse_.push_back(T(1) / factorial);
    }
  }
  const Pair<T>& full_turn() const { return full_turn_; }

  UnitVector<T> at_turns(const T& y) const { return detail::at_turns(y, turn_, inverses()); }
  // cos z - 1 and sin z - z of an angle |z| <= pi/4, without cancellation.
  UnitVector<T> beyond_linear(const T& z) const {
    const T x = -z * z;
    const UnitVector<T> of = detail::series(x, inverses());
    return {T(of.cos * x), T(of.sin * x * z)};
  }

 private:
  const auto& inverses() const {
    if constexpr (std::same_as<T, double>)  // as many, and the compiler unrolls the series
      return detail::inverse_factorials;
    else
      return inverse_;
  }

  Pair<T> full_turn_;
  T turn_;
  std::vector<T> inverse_;
};

}  // namespace cradle
