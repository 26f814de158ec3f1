#pragma once
// Every scalar type, with MPFR at several numbers of digits, for tests that are the same in all types, and wide numbers
// to compare them with. MPFR has one precision per process: the fixture sets it before a test makes its first number.

#include <gtest/gtest.h>

#ifdef CRADLE_WITH_MPFR
#include <boost/multiprecision/mpfr.hpp>
#endif

#include "cradle/core/engine/simulation.hpp"
#include "cradle/precision/scalars.hpp"

namespace cradle::test {

template <class T, unsigned Digits = 0> struct Precision {
  using Scalar = T;
  static constexpr unsigned digits = Digits;
};

template <class... Lists> struct Joined;
template <class... P> struct Joined<testing::Types<P...>> { using Types = testing::Types<P...>; };
template <class... P, class... Q, class... More>
struct Joined<testing::Types<P...>, testing::Types<Q...>, More...> : Joined<testing::Types<P..., Q...>, More...> {};

// The types that this build has.
#ifdef CRADLE_WITH_FLOAT128
using Binary128 = testing::Types<Precision<float128>>;
using FixedTypes = testing::Types<double, long double, double_double, float128>;
#else
using Binary128 = testing::Types<>;
using FixedTypes = testing::Types<double, long double, double_double>;
#endif
#ifdef CRADLE_WITH_MPFR
using Mpfr50 = testing::Types<Precision<Mpfr<4>, 50>>;
using EveryMpfr =
    testing::Types<Precision<Mpfr<4>, 20>, Precision<Mpfr<4>, 50>, Precision<Mpfr<16>, 200>, Precision<Mpfr<56>, 1000>>;
#else
using Mpfr50 = testing::Types<>;
using EveryMpfr = testing::Types<>;
#endif

using EveryPrecision =
    Joined<testing::Types<Precision<double>, Precision<long double>, Precision<double_double>, Precision<bin_float>>,
           Binary128, EveryMpfr>::Types;
// Types whose queue keys are rounded times, one of each kind.
using WidePrecision = Joined<testing::Types<Precision<double_double>>, Binary128, Mpfr50>::Types;
// One type of each kind of arithmetic, for tests that take too long with EveryPrecision.
using EachKindOfPrecision = Joined<testing::Types<Precision<double>, Precision<long double>>, WidePrecision>::Types;

struct PrecisionName {
  template <class P> static std::string GetName(int) {
    std::string name(scalar_name<typename P::Scalar>);
    for (char& c : name)
      if (c == ' ' || c == '-') c = '_';
    return P::digits > 0 ? name + std::to_string(P::digits) : name;
  }
};

#ifdef CRADLE_WITH_MPFR
// MPFR numbers of 1325 digits, which have a precision of their own: references for runs in any scalar type at any
// precision. Every scalar converts to one without error.
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
#endif

// The number in 100 digits, as a sum of doubles.
template <class T> bin_float in_100_digits(T x) {
  bin_float sum(0);
  for (int part = 0; part < 8 && !(x == T(0)); ++part) {
    const double leading = to_double(x);
    sum += bin_float(leading);
    x -= cradle::exactly<T>(leading);
  }
  return sum;
}

// Doubles exactly, decimals as the type rounds them.
template <class T> std::vector<T> numbers(const std::vector<double>& values) {
  std::vector<T> all;
  for (const double value : values) all.push_back(cradle::exactly<T>(value));
  return all;
}
template <class T> std::vector<T> numbers(const std::vector<std::string>& decimals) {
  std::vector<T> all;
  for (const std::string& decimal : decimals) all.push_back(from_text<T>(decimal));
  return all;
}

// Exact dynamics until a gap is smaller than this; 0: until the collapse time is known.
template <class T> Policy<T> stop_below(const T& gap) {
  Policy<T> policy;
  policy.collapse = CollapsePolicy::stop;
  policy.stop_gap = gap;
  return policy;
}

template <class P> class InPrecision : public testing::Test {
 protected:
  void SetUp() override {
#ifdef CRADLE_WITH_MPFR
    if (P::digits > 0) MpfrPrecision::set_bits(MpfrPrecision::bits_for(P::digits));
#endif
  }
};

// A suite in each of these precisions, and a case of it, in which T is the scalar.
#define PRECISION_SUITE(suite, precisions)                                                                             \
  template <class P> using suite = InPrecision<P>;                                                                     \
  TYPED_TEST_SUITE(suite, precisions, PrecisionName)
#define PRECISION_TEST(suite, name)                                                                                    \
  template <class TypeParam, class T> void suite##name();                                                              \
  TYPED_TEST(suite, name) { suite##name<TypeParam, typename TypeParam::Scalar>(); }                                    \
  template <class TypeParam, class T> void suite##name()

}  // namespace cradle::test
