// In every scalar type, for any numeric_limits, a run refuses to advance to an infinite time or to NaN, and can then
// continue. (In double-double a run to an infinite time used to make no collisions, without a message; in double NaN
// overwrote memory.)
#include <gtest/gtest.h>

#include <stdexcept>

#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace finite_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using Finite = InPrecision<P>;
TYPED_TEST_SUITE(Finite, EveryPrecision, PrecisionName);

TYPED_TEST(Finite, OnlyNumbersAreTimes) {
  using T = typename TypeParam::Scalar;
  const T infinite = T(1) / T(0), undefined = T(0) / T(0), tiny = std::numeric_limits<T>::min();
  EXPECT_TRUE(is_finite(T(0)) && is_finite(T(-7)) && is_finite(tiny) && is_finite(far_away<T>()));
  auto run = gap_run<T>(list<T>({T(0), T(1), T(3)}, {T(1), T(0), T(-1)}), Inelastic<T>(T(1)));
  for (const T& t : {infinite, T(-infinite), undefined}) {
    EXPECT_FALSE(is_finite(t));
    EXPECT_THROW(run.advance(t), std::invalid_argument);
  }
  EXPECT_EQ(run.advance(T(5)), Status::reached);
  EXPECT_EQ(run.counts().collisions, 3U);
}

}  // namespace finite_test
