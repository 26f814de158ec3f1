#pragma once
// Every scalar type, MPFR at several numbers of digits, for tests that are the same in all of them. MPFR's precision is
// one per process: the fixture sets it before a test makes its first number.

#include <gtest/gtest.h>

#include <string>

#include "cradle/core/engine/simulation.hpp"
#include "cradle/precision/scalars.hpp"

namespace cradle::test {

template <class T, unsigned Digits = 0> struct Precision {
  using Scalar = T;
  static constexpr unsigned digits = Digits;
};

template <class P> void set_precision() {
#ifdef CRADLE_WITH_MPFR
  if (P::digits > 0) MpfrPrecision::set_bits(MpfrPrecision::bits_for(P::digits));
#endif
}

using EveryPrecision =
    testing::Types<Precision<double>, Precision<long double>, Precision<double_double>, Precision<bin_float>
#ifdef CRADLE_WITH_FLOAT128
                   ,
                   Precision<float128>
#endif
#ifdef CRADLE_WITH_MPFR
                   ,
                   Precision<Mpfr<4>, 20>, Precision<Mpfr<4>, 50>, Precision<Mpfr<16>, 200>, Precision<Mpfr<56>, 1000>
#endif
                   >;

// Types in which the queue's keys are rounded times, one of each kind.
using WidePrecision = testing::Types<Precision<double_double>
#ifdef CRADLE_WITH_FLOAT128
                                     ,
                                     Precision<float128>
#endif
#ifdef CRADLE_WITH_MPFR
                                     ,
                                     Precision<Mpfr<4>, 50>
#endif
                                     >;

// One type of each kind of arithmetic, where EveryPrecision would take too long.
using EachKindOfPrecision = testing::Types<Precision<double>, Precision<long double>, Precision<double_double>
#ifdef CRADLE_WITH_FLOAT128
                                           ,
                                           Precision<float128>
#endif
#ifdef CRADLE_WITH_MPFR
                                           ,
                                           Precision<Mpfr<4>, 50>
#endif
                                           >;

struct PrecisionName {
  template <class P> static std::string GetName(int) {
    std::string name(scalar_name<typename P::Scalar>);
    for (char& c : name)
      if (c == ' ' || c == '-') c = '_';
    return P::digits > 0 ? name + std::to_string(P::digits) : name;
  }
};

// Exact dynamics until a gap is below this; 0: until the collapse time is settled.
template <class T> Policy<T> stop_below(const T& gap) {
  Policy<T> policy;
  policy.collapse = CollapsePolicy::stop;
  policy.stop_gap = gap;
  return policy;
}

template <class P> class InPrecision : public testing::Test {
 protected:
  using Scalar = typename P::Scalar;
  static constexpr unsigned digits = P::digits;
  void SetUp() override { set_precision<P>(); }
};

}  // namespace cradle::test
