#pragma once
// The transcendental functions that laws need, computed by the four operations, so that every machine and every build
// gets the same bits and every scalar type all of its digits. Libraries differ in the last place.
//
//   1 - exp(-y), y >= 0     h = y 2^-k <= 1/8; series; then k times E(2h) = E(h) (2 - E(h)), by which relative
//                           errors do not grow: each step adds a rounding or two. Nothing cancels for small y.
//   x^s, x >= 0, s > 0      whole s: products, halving s. Else exp(u), u = s ln x, with x = 2^n m, ln m = 2 artanh
//                           ((m - 1)/(m + 1)) and exp(u) = 2^j (1 - E(-v)) or 2^j/(1 - E(v)), u = j ln 2 + v. The
//                           relative error is that of u, some |u| + 8 units.
//
// Tables of reciprocals grow with the digits of the type; they are made once, with the law.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cradle/core/base/real.hpp"

namespace cradle {

namespace detail {

// The number of terms of a series of ones until they are below the type's epsilon; each is less than `ratio(n)` times
// the previous one.
template <Real T, class Ratio> int terms_needed(Ratio ratio) {
  T term(1);
  int n = 0;
  for (const T least = T(std::numeric_limits<T>::epsilon()) / T(16); term > least; ++n) term *= ratio(n + 1);
  return n;
}

// x 2^n; in two steps, since 2^n may be out of the range of the result.
template <Real T> T times_power_of_two(const T& x, std::int64_t n) {
  const auto times = [](T y, std::int64_t k) {
    T two(2);
    for (std::uint64_t left = static_cast<std::uint64_t>(k < 0 ? -k : k); left > 0; left /= 2) {
      if (left % 2 != 0) y = k < 0 ? T(y / two) : T(y * two);
      if (left > 1) two *= two;
    }
    return y;
  };
  return times(times(x, n / 2), n - n / 2);
}

// The n for which x 2^-n is between about 1/2 and 1; x > 0.
template <Real T> std::int64_t exponent_of(const T& x) {
  if constexpr (WiderRange<T>) {
    long exponent = 0;
    split(x, exponent);
    return exponent;
  } else {
    constexpr int step = 1000;
    std::int64_t beyond = 0;  // for types without `split` but with a wider range than double
    double near = to_double(x);
    for (; !(near > 0); near = to_double(times_power_of_two(x, beyond))) beyond += step;
    for (; !std::isfinite(near); near = to_double(times_power_of_two(x, beyond))) beyond -= step;
    int exponent = 0;
    std::frexp(near, &exponent);
    return exponent - beyond;
  }
}

}  // namespace detail

// 1 - exp(-y).
template <Real T> class ExponentialRise {
 public:
  ExponentialRise() {
    const int terms = detail::terms_needed<T>([](int n) { return T(1) / T(8 * (n + 1)); });
    for (int n = 1; n <= terms + 1; ++n) reciprocals_.push_back(T(1) / T(n));
    // Beyond this argument the exponential is less than epsilon/8: ln 2 < 0.7.
    for (T rest(1); rest > T(std::numeric_limits<T>::epsilon()) / T(8); rest /= T(2)) all_ += T(7) / T(10);
  }

  // y >= 0.
  T operator()(const T& y) const {
    if (!(y < all_)) return one_;
    T h = y;
    int doublings = 0;
    for (; h > eighth_; ++doublings) h *= half_;
    T bracket = one_;  // h (1 - h/2 (1 - h/3 (...)))
    for (std::size_t n = reciprocals_.size(); n-- > 1;) bracket = one_ - h * reciprocals_[n] * bracket;
    T rise = h * bracket;
    for (; doublings > 0; --doublings) rise *= two_ - rise;
    return rise;
  }

  // For who computes it as vectors.
  const std::vector<T>& reciprocals() const { return reciprocals_; }
  const T& all() const { return all_; }

 private:
  std::vector<T> reciprocals_;  // 1/1, 1/2, ...
  T all_{0}, one_{1}, two_{2}, half_{T(1) / T(2)}, eighth_{T(1) / T(8)};
};

// x^s for one s.
template <Real T> class Power {
 public:
  // s > 0.
  explicit Power(const T& exponent) : exponent_(exponent) {
    for (int n = 1; n <= most_products; ++n)
      if (exponent == T(n)) whole_ = n;
    const int terms = detail::terms_needed<T>([](int) { return T(3) / T(100); });  // ((m - 1)/(m + 1))^2 < 0.0295
    for (int n = 0; n <= terms; ++n) odd_.push_back(T(1) / T(2 * n + 1));
    // ln 2 by a formula like Machin's.
    ln2_ = T(18) * artanh(T(1) / T(26)) - T(2) * artanh(T(1) / T(4801)) + T(8) * artanh(T(1) / T(8749));
  }

  // x >= 0. Beyond the range of the type it returns the largest number, or 0.
  T operator()(const T& x) const {
    if (!is_positive(x)) return T(0);
    const T power = whole_ > 0 ? product(x) : exponential(T(exponent_ * logarithm(x)));
    return is_finite(power) ? power : T(std::numeric_limits<T>::max());
  }

  // ln x, x > 0.
  T logarithm(const T& x) const {
    std::int64_t exponent = detail::exponent_of(x);
    T mantissa = detail::times_power_of_two(x, -exponent);
    if (mantissa * mantissa * T(2) < T(1)) mantissa += mantissa, --exponent;
    return T(exponent) * ln2_ + T(2) * artanh(T((mantissa - T(1)) / (mantissa + T(1))));
  }
  // exp(u).
  T exponential(const T& u) const {
    const double turns = std::clamp(to_double(T(u / ln2_)), -0x1p40, 0x1p40);
    const auto exponent = static_cast<std::int64_t>(std::floor(turns + 0.5));
    const T rest = u - T(exponent) * ln2_;
    const T near = is_negative(rest) ? T(T(1) - rise_(T(-rest))) : T(T(1) / (T(1) - rise_(rest)));
    return detail::times_power_of_two(near, exponent);
  }

  // For who computes it as vectors: s, and as a whole number or 0; reciprocals of odd numbers; ln 2.
  const T& exponent() const { return exponent_; }
  int whole() const { return whole_; }
  const std::vector<T>& odd() const { return odd_; }
  const T& ln2() const { return ln2_; }

 private:
  static constexpr int most_products = 64;

  T product(T base) const {
    T result(1);
    for (int n = whole_; n > 0; n /= 2) {
      if (n % 2 != 0) result *= base;
      if (n > 1) base *= base;
    }
    return result;
  }
  // |s| < 0.172.
  T artanh(const T& s) const {
    const T square = s * s;
    T sum(0);
    for (std::size_t n = odd_.size(); n-- > 0;) sum = sum * square + odd_[n];
    return s * sum;
  }

  T exponent_;
  int whole_ = 0;       // s, if it is a whole number and not too large
  std::vector<T> odd_;  // 1, 1/3, 1/5, ...
  T ln2_{0};
  ExponentialRise<T> rise_;
};

}  // namespace cradle
