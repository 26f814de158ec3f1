#pragma once
// Double-double: an unevaluated sum of two doubles, |low| <= ulp(high)/2, some 31 decimal digits in the range of
// double. Algorithms and proven bounds: Joldes, Muller, Popescu, ACM TOMS 44 (2017), article 15res,
// doi 10.1145/3121432, with u = 2^-53:
//
//   sum         AccurateDWPlusDW (their algorithm 6)    relative error at most 3 u^2 + 13 u^3
//   product     DWTimesDW3 (12), with FMA               4 u^2
//   quotient    DWDivDW2 (17), with FMA                 15 u^2 + 56 u^3
//
// The bounds hold while nothing underflows, that is, while results stay above 2^-969, which is numeric_limits::min().
// Results above the largest number are NaN: infinity can be compared with, but not computed with.

#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "cradle/core/base/fields.hpp"
#include "cradle/precision/text.hpp"

namespace cradle {

class double_double {
 public:
  // core/parallel/steps/pairs.inl has the same operations on vectors.
  static constexpr bool is_double_double = true;

  constexpr double_double() = default;
  constexpr explicit double_double(int i) : high_(i) {}
  constexpr explicit double_double(std::int64_t i)
      : high_(static_cast<double>(i)), low_(static_cast<double>(i - nearest(high_)) - (high_ == 0x1p63 ? 1 : 0)) {}
  constexpr explicit double_double(double x) : high_(x) {}
  // The sum of two doubles of any sizes.
  static constexpr double_double sum(double a, double b) { return two_sum(a, b); }

  // The number with these doubles, which must come from high() and low().
  static constexpr double_double of(double high, double low) { return {high, low}; }

  constexpr double high() const { return high_; }
  constexpr double low() const { return low_; }
  explicit constexpr operator double() const { return high_; }
  static auto state(auto& self) { return fields(self.high_, self.low_); }

  // g++ 12 makes calls of some of these, which costs the event loop a fifth of its time: they are always inlined.
  friend constexpr double_double operator-(const double_double& x) { return {-x.high_, -x.low_}; }

  [[gnu::always_inline]] friend double_double operator+(const double_double& x, const double_double& y) {
    const double_double s = two_sum(x.high_, y.high_), t = two_sum(x.low_, y.low_);
    const double_double v = fast_two_sum(s.high_, s.low_ + t.high_);
    return fast_two_sum(v.high_, t.low_ + v.low_);
  }
  [[gnu::always_inline]] friend double_double operator-(const double_double& x, const double_double& y) {
    return x + -y;
  }

  [[gnu::always_inline]] friend double_double operator*(const double_double& x, const double_double& y) {
    const double product = x.high_ * y.high_;
    const double error = std::fma(x.high_, y.high_, -product);
    const double cross = std::fma(x.low_, y.high_, std::fma(x.high_, y.low_, x.low_ * y.low_));
    return fast_two_sum(product, error + cross);
  }

  [[gnu::always_inline]] friend double_double operator/(const double_double& x, const double_double& y) {
    const double quotient = x.high_ / y.high_;
    const double product = y.high_ * quotient;
    const double error = std::fma(y.high_, quotient, -product);
    const double_double r = fast_two_sum(product, std::fma(y.low_, quotient, error));
    const double remainder = (x.high_ - r.high_) + (x.low_ - r.low_);
    return fast_two_sum(quotient, remainder / y.high_);
  }

  double_double& operator+=(const double_double& y) { return *this = *this + y; }
  double_double& operator-=(const double_double& y) { return *this = *this - y; }
  double_double& operator*=(const double_double& y) { return *this = *this * y; }
  double_double& operator/=(const double_double& y) { return *this = *this / y; }

  friend constexpr bool operator==(const double_double&, const double_double&) = default;
  friend constexpr std::partial_ordering operator<=>(const double_double& x, const double_double& y) {
    const auto order = x.high_ <=> y.high_;
    return order == 0 ? x.low_ <=> y.low_ : order;
  }

  friend bool is_negative(const double_double& x) { return x.high_ < 0; }
  friend bool is_positive(const double_double& x) { return x.high_ > 0; }

  // Error at most a few u^2: one Newton step on the double root (Karp and Markstein 1997).
  friend double_double sqrt(const double_double& x) {
    if (!(x.high_ > 0)) return double_double(std::sqrt(x.high_));
    const double root = std::sqrt(x.high_);
    const double_double square{root * root, std::fma(root, root, -root * root)};
    return fast_two_sum(root, (x - square).high_ / (2 * root));
  }

 private:
  constexpr double_double(double high, double low) : high_(high), low_(low) {}

  // 2^63 is just beyond the range.
  static constexpr std::int64_t nearest(double x) {
    return x >= 0x1p63 ? std::numeric_limits<std::int64_t>::max() : static_cast<std::int64_t>(x);
  }

  // Exact for |a| >= |b|.
  static constexpr double_double fast_two_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  static constexpr double_double two_sum(double a, double b) {
    const double s = a + b;
    const double b_seen = s - a;
    return {s, (a - (s - b_seen)) + (b - b_seen)};
  }

  double high_ = 0, low_ = 0;
};

}  // namespace cradle

template <> class std::numeric_limits<cradle::double_double> {
 public:
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr bool has_infinity = true, has_quiet_NaN = true, is_iec559 = false, is_bounded = true;
  static constexpr int radix = 2;
  // The spacing of numbers near 1 is not fixed; operations keep 2^-104 or better.
  static constexpr int digits = 105, digits10 = 31, max_digits10 = 33;
  static constexpr int min_exponent = -968, max_exponent = 1024, min_exponent10 = -291, max_exponent10 = 308;
  static constexpr cradle::double_double epsilon() { return cradle::double_double(0x1p-104); }
  static constexpr cradle::double_double min() { return cradle::double_double(0x1p-969); }
  static constexpr cradle::double_double max() {
    return cradle::double_double::sum(std::numeric_limits<double>::max(), 0x1.fffffffffffffp+969);
  }
  static constexpr cradle::double_double lowest() { return -max(); }
  static constexpr cradle::double_double infinity() {
    return cradle::double_double(std::numeric_limits<double>::infinity());
  }
  static constexpr cradle::double_double quiet_NaN() {
    return cradle::double_double(std::numeric_limits<double>::quiet_NaN());
  }
};

template <> inline constexpr std::string_view cradle::scalar_name<cradle::double_double> = "double-double";

template <> struct cradle::Text<cradle::double_double> {
  static double_double from(std::string_view literal);
  static std::string to(const double_double& x);
};
