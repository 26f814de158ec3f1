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

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "cradle/precision/fixed_point.hpp"
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
  static auto state(auto& self) { return std::tie(self.high_, self.low_); }

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

// Conversions use a type that holds the sum of any two doubles exactly (from 2^1024 down to 2^-1074): each rounds once.
template <> inline constexpr std::string_view cradle::scalar_name<cradle::double_double> = "double-double";

template <> struct cradle::Text<cradle::double_double> {
  static double_double from(std::string_view literal) {
    const std::string text = checked_literal(literal);
    if (const auto x = in_fixed_point(text)) return *x;
    const auto quick = by_near(text);
    return quick ? *quick : rounded(Exact(text));
  }

  static std::string to(const double_double& x) {
    // High and low may differ greatly in size: add digits until the text is exact.
    for (int digits = 32;; digits += 8) {
      std::optional<bool> same;
      std::string text = written_in_fixed_point(x, digits, same);
      if (text.empty()) text = near(x) ? written<Near>(x, digits) : written<Exact>(x, digits);
      if (digits > 700 || (same ? *same : from(text) == x)) return text;
    }
  }

 private:
  template <unsigned bits>
  using Binary =
      boost::multiprecision::number<boost::multiprecision::cpp_bin_float<bits, boost::multiprecision::digit_base_2>,
                                    boost::multiprecision::et_off>;
  using Exact = Binary<2200>;
  using Near = Binary<256>;  // holds most sums exactly, and takes a sixth of the time

  template <class Number> static double_double rounded(const Number& exact) {
    const auto high = static_cast<double>(exact);
    return std::isfinite(high) ? double_double::sum(high, static_cast<double>(Number(exact - high)))
                               : double_double(high);
  }
  template <class Number> static std::string written(const double_double& x, int digits) {
    return Number(Number(x.high()) + x.low()).str(digits);
  }
  // As `written` does: without zeros at the end, with an exponent where there would be more than three after the point.
  // Empty where the number does not fit, or half a unit decides. `same`: whether it reads as x, if that is plain.
  static std::string written_in_fixed_point(const double_double& x, int digits, std::optional<bool>& same) {
    const double low = x.high() < 0 ? -x.low() : x.low(), high = std::abs(x.high());
    auto exact = FixedPoint::sum({high, low});
    auto leading = exact ? exact->take_leading(static_cast<std::size_t>(digits)) : std::nullopt;
    if (!leading) return {};
    auto& [text, exponent] = *leading;
    const double behind = exact->nearest();
    if (behind == 0.5) return {};
    if (behind > 0.5) {
      const auto last = text.find_last_not_of('9');
      if (last == text.npos) return {};
      ++text[last];
      text.resize(last + 1);
      exact->add(-1);
    }
    if (exponent - digits > -250)  // far from what underflows
      same = reads_as(high, low, std::abs(exact->nearest()) * std::pow(10., exponent - digits + 1));
    text.resize(text.find_last_not_of('0') + 1);
    const std::string sign = x.high() < 0 ? "-" : "";
    if (exponent < -4) {
      const std::string power = std::to_string(-exponent);
      if (text.size() > 1) text.insert(1, ".");
      return sign + text + (power.size() < 2 ? "e-0" : "e-") + power;
    }
    if (exponent < 0) return sign + "0." + std::string(static_cast<std::size_t>(-exponent) - 1, '0') + text;
    const auto whole = static_cast<std::size_t>(exponent) + 1;
    if (text.size() > whole) return sign + text.insert(whole, ".");
    return sign + text + std::string(whole - text.size(), '0');
  }
  // Whether a decimal that is `off` from high + low is rounded to that, unless this depends on the side.
  static std::optional<bool> reads_as(double high, double low, double off) {
    if (off == 0) return true;
    if (low == 0) return false;
    const double unit = std::ldexp(1, std::ilogb(low) - 52);
    if (off > 0.51 * unit) return false;
    if (off < 0.24 * unit && high + (low + unit) == high && high + (low - unit) == high) return true;
    return {};
  }
  // The number of a decimal, if both ends of what fixed point leaves open round to it: rounding is monotonic.
  static std::optional<double_double> in_fixed_point(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    bool is_exact = false;
    auto number = FixedPoint::decimal(text, is_exact);
    if (!number) return {};
    if (is_exact && number->is_zero()) return double_double(0);
    const auto rounded = [sign = negative ? -1. : 1.](FixedPoint exact) {
      const double high = exact.nearest();
      return exact.add(-high) ? std::optional(double_double::sum(sign * high, sign * exact.nearest())) : std::nullopt;
    };
    const auto x = rounded(*number);
    if (!is_exact) {
      number->add_units(2);
      if (rounded(*number) != x) return {};
    }
    return x;
  }
  static bool near(const double_double& x) { return x.low() == 0 || std::ilogb(x.high()) - std::ilogb(x.low()) < 150; }
  // The number of a decimal, if Near decides it. Rounding is monotonic: if both ends of the error interval of Near
  // round to one number, so does the decimal between them.
  static std::optional<double_double> by_near(const std::string& text) {
    const Near middle(text), off = ldexp(Near(abs(middle)), -240);
    const double_double one_end = rounded(Near(middle - off)), other = rounded(Near(middle + off));
    return one_end == other ? std::optional(one_end) : std::nullopt;
  }
};
