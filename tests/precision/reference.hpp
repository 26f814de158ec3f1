#pragma once
// MPFR numbers of 4400 bits, about 1300 digits, on the heap and with a precision of their own: references for runs in
// any scalar type at any precision. Every scalar converts to one without error.

#include <mpfr.h>

#include <cmath>
#include <concepts>
#include <ostream>

#include "cradle/core/base/real.hpp"
#include "cradle/precision/mpfr_text.hpp"
#include "cradle/precision/scalars.hpp"

namespace cradle::test {

class Reference {
 public:
  static constexpr mpfr_prec_t bits = 4400;

  Reference(double x = 0) {
    mpfr_init2(v_, bits);
    mpfr_set_d(v_, x, MPFR_RNDN);
  }
  explicit Reference(const char* literal) : Reference() { mpfr_strtofr(v_, literal, nullptr, 10, MPFR_RNDN); }
  explicit Reference(mpfr_srcptr x) : Reference() { mpfr_set(v_, x, MPFR_RNDN); }
  Reference(const Reference& x) : Reference(x.v_) {}
  Reference& operator=(const Reference& x) {
    mpfr_set(v_, x.v_, MPFR_RNDN);
    return *this;
  }
  ~Reference() { mpfr_clear(v_); }

  mpfr_srcptr get() const { return v_; }
  mpfr_ptr get() { return v_; }
  explicit operator double() const { return mpfr_get_d(v_, MPFR_RNDN); }

  friend Reference operator-(const Reference& x) { return Reference(0.) - x; }
  friend Reference operator+(const Reference& x, const Reference& y) { return make(mpfr_add, x, y); }
  friend Reference operator-(const Reference& x, const Reference& y) { return make(mpfr_sub, x, y); }
  friend Reference operator*(const Reference& x, const Reference& y) { return make(mpfr_mul, x, y); }
  friend Reference operator/(const Reference& x, const Reference& y) { return make(mpfr_div, x, y); }
  friend bool operator==(const Reference& x, const Reference& y) { return mpfr_equal_p(x.v_, y.v_) != 0; }
  friend bool operator<(const Reference& x, const Reference& y) { return mpfr_less_p(x.v_, y.v_) != 0; }
  friend bool operator<=(const Reference& x, const Reference& y) { return mpfr_lessequal_p(x.v_, y.v_) != 0; }
  friend Reference abs(const Reference& x) {
    Reference result;
    mpfr_abs(result.v_, x.v_, MPFR_RNDN);
    return result;
  }
  friend Reference sqrt(const Reference& x) {
    Reference result;
    mpfr_sqrt(result.v_, x.v_, MPFR_RNDN);
    return result;
  }
  // 2^exponent x.
  friend Reference scaled(const Reference& x, long exponent) {
    Reference result;
    mpfr_mul_2si(result.v_, x.v_, exponent, MPFR_RNDN);
    return result;
  }
  // Rounds to the nearest number of so many bits.
  friend Reference rounded(const Reference& x, long to_bits) {
    mpfr_t narrow;
    mpfr_init2(narrow, to_bits);
    mpfr_set(narrow, x.v_, MPFR_RNDN);
    const Reference result(narrow);
    mpfr_clear(narrow);
    return result;
  }
  friend std::ostream& operator<<(std::ostream& out, const Reference& x) { return out << mpfr_text(x.v_, 50); }

 private:
  template <class Operation> static Reference make(Operation operation, const Reference& x, const Reference& y) {
    Reference result;
    operation(result.v_, x.v_, y.v_, MPFR_RNDN);
    return result;
  }

  mpfr_t v_;
};

// The same number, exactly.
inline Reference reference(double x) { return x; }
inline Reference reference(long double x) {
  Reference result;
  mpfr_set_ld(result.get(), x, MPFR_RNDN);
  return result;
}
inline Reference reference(const double_double& x) { return Reference(x.high()) + Reference(x.low()); }
// A template, to prevent implicit conversions to its argument.
template <std::same_as<bin_float> T> Reference reference(const T& x) {
  int exponent = 0;
  Reference sum;
  for (bin_float rest = frexp(x, &exponent); rest != 0;) {
    const auto part = static_cast<double>(rest);
    sum = sum + Reference(part);
    rest -= part;
  }
  return scaled(sum, exponent);
}
#ifdef CRADLE_WITH_FLOAT128
inline Reference reference(const float128& x) {
  int exponent = 0;
  Reference sum;
  for (float128 rest = float128::from(frexpq(x.value(), &exponent)); rest != float128(0);) {
    const auto part = static_cast<double>(rest);
    sum = sum + Reference(part);
    rest -= float128(part);
  }
  return scaled(sum, exponent);
}
#endif
template <int Limbs> Reference reference(const Mpfr<Limbs>& x) { return Reference(x.get()); }

template <class T> Reference reference(const Pair<T>& x) { return reference(x.high) + reference(x.low); }

// The largest relative error of one operation of a type: half its epsilon, or for the quotient of double-doubles 15 u^2
// + 56 u^3 < 4 epsilon (u = 2^-53, epsilon = 4 u^2).
template <class T> Reference rounding() {
  const Reference epsilon = reference(std::numeric_limits<T>::epsilon());
  return std::same_as<T, double_double> ? epsilon * Reference(4) : epsilon / Reference(2);
}

}  // namespace cradle::test
