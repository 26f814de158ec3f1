#pragma once
// MPFR numbers of 1325 digits, which have a precision of their own: references for runs in any scalar type at any
// precision. Every scalar converts to one without error.

#include <boost/multiprecision/mpfr.hpp>

#include <concepts>

#include "cradle/core/base/real.hpp"
#include "cradle/precision/scalars.hpp"

namespace cradle::test {

using Reference =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<1325>, boost::multiprecision::et_off>;

// Rounds to the nearest number of so many bits.
inline Reference rounded(const Reference& x, long to_bits) {
  mpfr_t narrow;
  mpfr_init2(narrow, to_bits);
  mpfr_set(narrow, x.backend().data(), MPFR_RNDN);
  const Reference result(narrow);
  mpfr_clear(narrow);
  return result;
}

// The same number, exactly.
inline Reference reference(double x) { return Reference(x); }
inline Reference reference(long double x) { return Reference(x); }
inline Reference reference(const double_double& x) { return Reference(x.high()) + Reference(x.low()); }
// A template, to prevent implicit conversions to its argument.
template <std::same_as<bin_float> T> Reference reference(const T& x) { return Reference(x); }
#ifdef CRADLE_WITH_FLOAT128
inline Reference reference(const float128& x) {
  int exponent = 0;
  Reference sum(0);
  for (float128 rest = float128::from(frexpq(x.value(), &exponent)); rest != float128(0);) {
    const auto part = static_cast<double>(rest);
    sum += Reference(part);
    rest -= float128(part);
  }
  return ldexp(sum, exponent);
}
#endif
template <int Limbs> Reference reference(const Mpfr<Limbs>& x) { return Reference(x.get()); }

template <class T> Reference reference(const Pair<T>& x) { return reference(x.high) + reference(x.low); }

// The largest relative error of one operation of a type: half its epsilon, or for the quotient of double-doubles 15 u^2
// + 56 u^3 < 4 epsilon (u = 2^-53, epsilon = 4 u^2).
template <class T> Reference rounding() {
  const Reference epsilon = reference(std::numeric_limits<T>::epsilon());
  return std::same_as<T, double_double> ? Reference(epsilon * 4) : Reference(epsilon / 2);
}

}  // namespace cradle::test
