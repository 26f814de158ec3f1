#pragma once
// The strictest scalar that the engine must accept: only the arithmetic of double. Conversions from an int or a 64-bit
// integer and to a double are explicit; there is no default value, and std:: mathematics is found by argument-dependent
// lookup only. Code that compiles with it has no implicit conversions; its results have the bits of double.

#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace cradle::test {

class StrictReal {
 public:
  explicit StrictReal(int value) : value_(value) {}
  explicit StrictReal(std::int64_t value) : value_(static_cast<double>(value)) {}
  template <class Other>
  requires std::is_arithmetic_v<Other> StrictReal(Other)
  = delete;

  // For tests; the engine does not use it.
  static StrictReal of(double value) {
    StrictReal x(0);
    x.value_ = value;
    return x;
  }

  explicit operator double() const { return value_; }
  template <class Other>
  requires(std::is_arithmetic_v<Other> && !std::same_as<Other, double>) explicit operator Other() const = delete;

  friend StrictReal operator+(const StrictReal& a, const StrictReal& b) { return of(a.value_ + b.value_); }
  friend StrictReal operator-(const StrictReal& a, const StrictReal& b) { return of(a.value_ - b.value_); }
  friend StrictReal operator*(const StrictReal& a, const StrictReal& b) { return of(a.value_ * b.value_); }
  friend StrictReal operator/(const StrictReal& a, const StrictReal& b) { return of(a.value_ / b.value_); }
  friend StrictReal operator-(const StrictReal& a) { return of(-a.value_); }
  StrictReal& operator+=(const StrictReal& b) { return *this = *this + b; }
  StrictReal& operator-=(const StrictReal& b) { return *this = *this - b; }
  StrictReal& operator*=(const StrictReal& b) { return *this = *this * b; }
  StrictReal& operator/=(const StrictReal& b) { return *this = *this / b; }
  friend bool operator==(const StrictReal& a, const StrictReal& b) { return a.value_ == b.value_; }
  friend std::partial_ordering operator<=>(const StrictReal& a, const StrictReal& b) { return a.value_ <=> b.value_; }

  friend StrictReal sqrt(const StrictReal& a) { return of(std::sqrt(a.value_)); }
  friend StrictReal log(const StrictReal& a) { return of(std::log(a.value_)); }
  friend StrictReal atan(const StrictReal& a) { return of(std::atan(a.value_)); }
  friend StrictReal cos(const StrictReal& a) { return of(std::cos(a.value_)); }

 private:
  double value_;
};

// A double in a type that may be this one.
template <class T> T number(double x) {
  if constexpr (std::same_as<T, StrictReal>)
    return StrictReal::of(x);
  else
    return x;
}

}  // namespace cradle::test

template <> struct std::numeric_limits<cradle::test::StrictReal> {
  using Real = cradle::test::StrictReal;
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr int radix = 2, digits = 53;
  static Real epsilon() { return Real::of(std::numeric_limits<double>::epsilon()); }
  static Real min() { return Real::of(std::numeric_limits<double>::min()); }
  static Real max() { return Real::of(std::numeric_limits<double>::max()); }
  static Real lowest() { return Real::of(std::numeric_limits<double>::lowest()); }
};
