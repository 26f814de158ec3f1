#pragma once
// IEEE binary128, 113 bits, about 34 decimal digits: the compiler's __float128, with libquadmath for roots and text, in
// a class of its own, so that the engine's templates see a type without conversions. (Boost.Multiprecision 1.74's
// float128 compiles in GNU mode only.) It needs g++: clang cannot include quadmath.h. The engine often needs signs and
// exponents, so they are read from the bits instead of calling the soft-float library.

#include <quadmath.h>

#include <bit>
#include <compare>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "cradle/precision/text.hpp"

namespace cradle {

class float128 {
 public:
  __extension__ using Value = __float128;

  constexpr float128() = default;
  constexpr explicit float128(int i) : value_(i) {}
  constexpr explicit float128(std::int64_t i) : value_(i) {}
  constexpr explicit float128(double x) : value_(x) {}
  static constexpr float128 from(Value x) {
    float128 result;
    result.value_ = x;
    return result;
  }
  constexpr Value value() const { return value_; }
  constexpr explicit operator double() const { return static_cast<double>(value_); }

  friend constexpr float128 operator-(const float128& x) { return from(-x.value_); }
  friend constexpr float128 operator+(const float128& x, const float128& y) { return from(x.value_ + y.value_); }
  friend constexpr float128 operator-(const float128& x, const float128& y) { return from(x.value_ - y.value_); }
  friend constexpr float128 operator*(const float128& x, const float128& y) { return from(x.value_ * y.value_); }
  friend constexpr float128 operator/(const float128& x, const float128& y) { return from(x.value_ / y.value_); }
  constexpr float128& operator+=(const float128& y) { return value_ += y.value_, *this; }
  constexpr float128& operator-=(const float128& y) { return value_ -= y.value_, *this; }
  constexpr float128& operator*=(const float128& y) { return value_ *= y.value_, *this; }
  constexpr float128& operator/=(const float128& y) { return value_ /= y.value_, *this; }

  friend constexpr bool operator==(const float128& x, const float128& y) { return x.value_ == y.value_; }
  friend constexpr std::partial_ordering operator<=>(const float128& x, const float128& y) {
    return x.value_ <=> y.value_;
  }
  friend constexpr bool operator<(const float128& x, const float128& y) { return x.value_ < y.value_; }

  friend bool is_positive(const float128& x) {
    const Words w = x.words();
    return !(w.high >> 63) && (w.high | w.low) != 0;
  }
  friend bool is_negative(const float128& x) {
    const Words w = x.words();
    return (w.high >> 63) && (w.high << 1 | w.low) != 0;
  }

  // x = mantissa 2^exponent, mantissa in [1/2, 1) or 0, good to 2^-52.
  friend double split(const float128& x, long& exponent) {
    const Words w = x.words();
    const auto biased = static_cast<long>(w.high >> 48 & 0x7FFF);
    if (biased == 0) {  // zero or subnormal: use the library
      int e = 0;
      const auto mantissa = static_cast<double>(frexpq(x.value_, &e));
      exponent = e;
      return mantissa;
    }
    exponent = biased - 16382;
    const auto fraction = static_cast<std::int64_t>((w.high & 0xFFFFFFFFFFFF) << 4 | w.low >> 60);  // 52 bits
    const double mantissa = 0.5 + static_cast<double>(fraction) * 0x1p-53;
    return w.high >> 63 ? -mantissa : mantissa;
  }

  friend float128 sqrt(const float128& x) { return from(sqrtq(x.value_)); }

 private:
  struct Words {
    std::uint64_t low, high;
  };
  Words words() const { return std::bit_cast<Words>(value_); }

  Value value_ = 0;
};

}  // namespace cradle

template <> class std::numeric_limits<cradle::float128> {
  using T = cradle::float128;

 public:
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr std::float_round_style round_style = std::round_to_nearest;
  static constexpr bool has_infinity = true, has_quiet_NaN = true, is_iec559 = true, is_bounded = true;
  static constexpr int radix = 2, digits = 113, digits10 = 33, max_digits10 = 36;
  static constexpr int min_exponent = -16381, max_exponent = 16384, min_exponent10 = -4931, max_exponent10 = 4932;
  static T epsilon() { return T::from(ldexpq(1, -112)); }
  static T min() { return T::from(ldexpq(1, -16382)); }
  static T max() { return T::from(ldexpq(2 - ldexpq(1, -112), 16383)); }
  static T lowest() { return -max(); }
  static T infinity() { return T(std::numeric_limits<double>::infinity()); }
  static T quiet_NaN() { return T::from(nanq("")); }
};

template <> inline constexpr std::string_view cradle::scalar_name<cradle::float128> = "float128";

template <> struct cradle::Text<cradle::float128> {
  static float128 from(std::string_view literal) {
    return float128::from(strtoflt128(checked_literal(literal).c_str(), nullptr));
  }
  static std::string to(const float128& x) {
    char buffer[64];
    for (int digits = 33; digits < 37; ++digits) {  // 36 distinguish any two numbers
      quadmath_snprintf(buffer, sizeof buffer, "%.*Qg", digits, x.value());
      if (from(buffer) == x) break;
    }
    return buffer;
  }
};

template <> struct cradle::SavedNumber<cradle::float128> {
  static void save(auto& to, const float128& x) {
    const float128::Value value = x.value();
    to.put(&value, sizeof value);
  }
  static void load(auto& from, float128& x) {
    float128::Value value = 0;
    from.get(&value, sizeof value);
    x = float128::from(value);
  }
};
