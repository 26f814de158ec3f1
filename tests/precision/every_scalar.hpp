#pragma once
// Every scalar type, with MPFR at several numbers of digits, for tests that are the same in all types. MPFR has one
// precision per process: the fixture sets it before a test makes its first number.

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

}  // namespace cradle::test
