#pragma once
// Balls: a number known to be within `radius` of a midpoint. The result of an operation contains all possible results
// for its operands: the midpoint is rounded as its type rounds, and a bound on that rounding is added to the radius.
// Radii are rounded upwards by a factor that covers their own operations; no rounding mode is changed.
//
// Midpoints and the relative errors of their operations, u = 2^-53, p bits:
//
//   double-double   sum 3 u^2 + 13 u^3, product 4 u^2, quotient 15 u^2 + 56 u^3 (double_double.hpp: Joldes, Muller and
//                   Popescu 2017, doi 10.1145/3121432; formally verified by Muller and Rideau 2022,
//                   doi 10.1145/3484514), if nothing underflows; an absolute term bounds underflow
//   MPFR            half a unit in the last place: 2^-p
//
// Radii are doubles for double-double, which has the same range, and long doubles for MPFR: collapses reach gaps of
// 1e-290, known to hundreds of digits. If long double is no wider than double, radii end at 1e-308, and what needs
// smaller ones remains undecided.
//
// Comparisons are certain: a < b means that all of a is less than all of b, so it is possible that neither a < b nor a
// >= b holds. order() says which of these is certain. It compares in plain doubles with an error bound if these
// suffice.
//
// Two computations from the same ball are not known to be the same number: x - x is a ball around 0. There are separate
// operations for combinations whose radii must not grow (combined).

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string_view>

#include "cradle/core/base/real.hpp"
#include "cradle/core/certify/enclosing.hpp"
#include "cradle/precision/double_double.hpp"
#include "cradle/precision/text.hpp"
#ifdef CRADLE_WITH_MPFR
#include "cradle/precision/mpfr.hpp"
#endif

namespace cradle {

// What balls require of their midpoints: sizes, with relative errors below 2^-50, and upper bounds of relative errors,
// as radii.
template <class M> struct Midpoint;

template <> struct Midpoint<double_double> {
  using Radius = double;
  static double size(const double_double& x) { return std::abs(x.high()); }
  static double sum_error() { return 0x1p-104; }      // > 3 u^2 + 13 u^3
  static double product_error() { return 0x1p-103; }  // > 4 u^2
  static double quotient_error() { return 0x1p-102; }
  static double literal_error() { return 0x1p-105; }
  // Error terms of products below 2^-969 are lost; they are less than this. Sums lose nothing.
  static double lost() { return 0x1p-1000; }
  static double lost_in_sum() { return 0; }
  // A double that differs by less than 2^-52 relatively or by less than 2^-990.
  static double near(const double_double& x) { return x.high(); }
};

#ifdef CRADLE_WITH_MPFR
template <int Limbs> struct Midpoint<Mpfr<Limbs>> {
  using Radius = long double;
  static long double size(const Mpfr<Limbs>& x) {
    long exponent = 0;
    const double mantissa = std::abs(split(x, exponent));
    return std::ldexp(static_cast<long double>(mantissa), static_cast<int>(exponent)) + lost();
  }
  static long double sum_error() { return std::ldexp(1.L, -static_cast<int>(MpfrPrecision::bits())) + lost(); }
  static long double product_error() { return sum_error(); }
  static long double quotient_error() { return sum_error(); }
  static long double literal_error() { return sum_error(); }
  static long double lost() { return std::numeric_limits<long double>::min(); }  // of radii and sizes
  static long double lost_in_sum() { return lost(); }
  static double near(const Mpfr<Limbs>& x) {
    long exponent = 0;
    const double mantissa = split(x, exponent);
    return scale(mantissa, exponent);
  }
};
#endif

template <class M> class Ball {
  using Of = Midpoint<M>;

 public:
  using Radius = typename Of::Radius;

  // Integers and doubles are exact: midpoints have more than 64 bits.
  Ball() : middle_(0) {}
  explicit Ball(int i) : middle_(i) {}
  explicit Ball(std::int64_t i) : middle_(i) {}
  explicit Ball(double x) : middle_(x) {}
  Ball(const M& middle, Radius radius) : middle_(middle), radius_(radius) {}

  const M& middle() const { return middle_; }
  Radius radius() const { return radius_; }
  explicit operator double() const { return to_double(middle_); }

  friend Ball operator-(const Ball& x) { return {-x.middle_, x.radius_}; }
  // Midpoints are not const: g++ 12 would hold such objects in memory, and make no vectors of loops over balls.
  friend Ball operator+(const Ball& x, const Ball& y) {
    M middle = x.middle_ + y.middle_;
    return {middle, up(x.radius_ + y.radius_ + Of::sum_error() * Of::size(middle) + Of::lost_in_sum())};
  }
  friend Ball operator-(const Ball& x, const Ball& y) {
    M middle = x.middle_ - y.middle_;
    return {middle, up(x.radius_ + y.radius_ + Of::sum_error() * Of::size(middle) + Of::lost_in_sum())};
  }
  friend Ball operator*(const Ball& x, const Ball& y) {
    M middle = x.middle_ * y.middle_;
    return {middle, up(Of::size(x.middle_) * y.radius_ + (Of::size(y.middle_) + y.radius_) * x.radius_ +
                       Of::product_error() * Of::size(middle) + Of::lost())};
  }
  // The radius is infinite if the divisor may be 0.
  friend Ball operator/(const Ball& x, const Ball& y) {
    const Ball quotient = quotient_by_nonzero(x, y);
    if (!(y.least_size() > 0)) return {quotient.middle_, std::numeric_limits<Radius>::infinity()};
    return quotient;
  }
  // As x / y, but it means nothing unless y is certainly not 0.
  friend Ball quotient_by_nonzero(const Ball& x, const Ball& y) {
    M middle = x.middle_ / y.middle_;
    const Radius least = y.least_size(), size = Of::size(middle);
    return {middle, up((x.radius_ + size * y.radius_) / least + Of::quotient_error() * size * (1 + y.radius_ / least) +
                       Of::lost() / least + Of::lost())};
  }
  Ball& operator+=(const Ball& y) { return *this = *this + y; }
  Ball& operator-=(const Ball& y) { return *this = *this - y; }
  Ball& operator*=(const Ball& y) { return *this = *this * y; }
  Ball& operator/=(const Ball& y) { return *this = *this / y; }

  // The root of a ball that is certainly positive; it is infinite otherwise. Let s be the computed root of the midpoint
  // x, with any error: |s - sqrt(y)| = |s^2 - y| / (s + sqrt(y)) <= (|s^2 - x| + |x - y|) / s.
  friend Ball sqrt(const Ball& x) {
    using std::sqrt;
    if (!(x.least_size() > 0) || !is_positive(x.middle_)) return {x.middle_, std::numeric_limits<Radius>::infinity()};
    const Ball root(sqrt(x.middle_), 0);
    const Ball off = root * root - Ball(x.middle_, 0);
    return {root.middle_, up((Of::size(off.middle_) + off.radius_ + x.radius_) / root.least_size())};
  }

  static Ball widened(const Ball& x, Radius by) { return {x.middle_, up(x.radius_ + by)}; }

  // Upper and lower bound of the absolute values in it.
  Radius size() const { return up(Of::size(middle_) + radius_); }
  Radius least_size() const { return (Of::size(middle_) * down - 2 * Of::lost() - radius_) * down; }

  // Compares in plain doubles; open if they do not decide.
  friend Order order_in_doubles(const Ball& x, const Ball& y) {
    return less_in_doubles(x, y) ? Order::less : less_in_doubles(y, x) ? Order::greater : Order::open;
  }
  friend bool less_in_doubles(const Ball& x, const Ball& y) {
    const double a = Of::near(x.middle_), b = Of::near(y.middle_);
    const double error = (upper_double(x.radius_) + upper_double(y.radius_)) * (1 + 0x1p-50) +
                         0x1p-50 * (std::abs(a) + std::abs(b)) + 0x1p-980;
    return b - a > error;
  }
  friend Order order_in_balls(const Ball& x, const Ball& y) {
    const Ball apart = y - x;
    if (!(apart.least_size() > 0)) return Order::open;
    return is_positive(apart.middle_) ? Order::less : Order::greater;
  }
  friend Order order(const Ball& x, const Ball& y) {
    const Order order = order_in_doubles(x, y);
    return order != Order::open ? order : order_in_balls(x, y);
  }
  friend bool operator<(const Ball& x, const Ball& y) { return order(x, y) == Order::less; }
  friend bool operator>(const Ball& x, const Ball& y) { return y < x; }
  friend bool operator<=(const Ball& x, const Ball& y) { return x < y || x == y; }
  friend bool operator>=(const Ball& x, const Ball& y) { return y <= x; }
  // Whether both are certainly the same number.
  friend bool operator==(const Ball& x, const Ball& y) {
    return x.radius_ == 0 && y.radius_ == 0 && x.middle_ == y.middle_;
  }

  friend bool is_positive(const Ball& x) { return is_positive(x.middle_) && x.least_size() > 0; }
  // Without a jump.
  friend bool certainly_positive(const Ball& x) { return is_positive(x.middle_) & (x.least_size() > 0); }
  friend bool is_negative(const Ball& x) { return is_negative(x.middle_) && x.least_size() > 0; }
  friend bool is_finite(const Ball& x) {
    return is_finite(x.middle_) && x.radius_ <= std::numeric_limits<Radius>::max();
  }

  // What it is made of, where that is doubles.
  static constexpr std::size_t doubles = 3;
  std::array<double, doubles> in_doubles() const requires std::same_as<M, double_double> {
    return {middle_.high(), middle_.low(), radius_};
  }
  static Ball of_doubles(const std::array<double, doubles>& of) requires std::same_as<M, double_double> {
    return {double_double::of(of[0], of[1]), of[2]};
  }

  // The share c of a combination, with the sizes of c and 1 - c.
  class Share {
   public:
    explicit Share(const Ball& c)
        : c_(c), size_(c.size()), rest_((Ball(1) - c).size()),
          rounding_(up((Of::sum_error() + Of::product_error() * 2) * size_)) {}
    // A share that depends on the difference w of the numbers that it combines: c is its value in the middle of w,
    // `slope` encloses the derivative of c(w) w in all of w. By the mean value theorem the radius is |1 - slope| r_x +
    // |slope| r_y; and the rounding of w acts with the slope.
    Share(const Ball& c, const Ball& slope)
        : c_(c), size_(slope.size()), rest_((Ball(1) - slope).size()),
          rounding_(up((Of::sum_error() + Of::product_error() * 2) * (c.size() + size_))) {}

   private:
    friend Ball;
    Ball c_;
    Radius size_, rest_;  // of c, of 1 - c; or of the slope
    Radius rounding_;
  };
  // Moves two numbers towards each other, given `apart` = x - y: (1 - c) x + c y and (1 - d) y + d x. The radius is |1
  // - c| r_x + |c| r_y plus the contributions of c and of rounding: for 0 <= c <= 1 an average. The same numbers
  // written as x - c (x - y) would have r_x + c (r_x + r_y).
  struct Both {
    Ball left, right;
  };
  static Both combined(const Ball& x, const Ball& y, const Ball& apart, const Share& c, const Share& d) {
    M by_c = c.c_.middle_ * apart.middle_;
    const Radius off_c = off(x, y, apart, c);
    if (&c == &d) return {moved(x, y, x.middle_ - by_c, c, off_c), moved(y, x, y.middle_ + by_c, c, off_c)};
    return {moved(x, y, x.middle_ - by_c, c, off_c),
            moved(y, x, y.middle_ + d.c_.middle_ * apart.middle_, d, off(x, y, apart, d))};
  }

 private:
  static constexpr Radius down = static_cast<Radius>(1 - 0x1p-48);
  // Enlarges a radius that was rounded up to 15 times, from sizes with relative errors of 2^-50, by more than these
  // errors can have removed.
  static Radius up(Radius r) { return r * static_cast<Radius>(1 + 0x1p-48); }
  static double upper_double(Radius r) {
    if constexpr (std::is_same_v<Radius, double>)
      return r;
    else
      return r < 1e300L ? static_cast<double>(r) * (1 + 0x1p-50) + 0x1p-1000 : std::numeric_limits<double>::infinity();
  }
  // The rounding error of c times `apart`, and the contribution of the radius of c.
  static Radius off(const Ball& x, const Ball& y, const Ball& apart, const Share& c) {
    const Radius width = Of::size(apart.middle_);
    return c.rounding_ * width + c.c_.radius_ * (width + x.radius_ + y.radius_) + Of::lost();
  }
  static Ball moved(const Ball& x, const Ball& y, const M& middle, const Share& c, Radius off) {
    return {middle, up(c.rest_ * x.radius_ + c.size_ * y.radius_ + off + Of::sum_error() * Of::size(middle))};
  }

  M middle_;
  Radius radius_ = 0;
};

// Has no error terms: they would be balls as wide as the sum, and a ball carries its own error.
template <class M> struct CompensatedSum<Ball<M>> {
  Ball<M> sum;

  void add(const Ball<M>& term) { sum += term; }
  Ball<M> value() const { return sum; }
};

// Encloses a decimal literal; integers that every midpoint type holds are exact.
template <class M> struct Text<Ball<M>> {
  static Ball<M> from(std::string_view literal) {
    M middle = from_text<M>(literal);
    using Of = Midpoint<M>;
    const std::size_t sign = literal.starts_with('-') || literal.starts_with('+');
    if (literal.size() <= sign + 15 && literal.find_first_not_of("0123456789", sign) == literal.npos)
      return {middle, 0};
    return {middle, (Of::literal_error() * Of::size(middle) + Of::lost()) * (1 + 0x1p-48)};
  }
};

}  // namespace cradle

template <class M> class std::numeric_limits<cradle::Ball<M>> {
  using Ball = cradle::Ball<M>;
  using Of = std::numeric_limits<M>;

 public:
  static constexpr bool is_specialized = true, is_signed = true, is_integer = false, is_exact = false;
  static constexpr bool has_infinity = true, has_quiet_NaN = true, is_iec559 = false, is_bounded = true;
  static constexpr int radix = 2;
  static Ball epsilon() { return {Of::epsilon(), 0}; }
  static Ball min() { return {Of::min(), 0}; }
  static Ball max() { return {Of::max(), 0}; }
  static Ball lowest() { return {Of::lowest(), 0}; }
  static Ball infinity() { return {Of::infinity(), 0}; }
};
