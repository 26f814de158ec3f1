// Proves: a light particle between a wall that takes energy and a heavy particle, elastic at low speeds, comes to an
// end in every type, also in types with unlimited exponents.
#include <gtest/gtest.h>

#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace standstill_wide_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using SlowStandstill = InPrecision<P>;
TYPED_TEST_SUITE(SlowStandstill, WidePrecision, PrecisionName);

TYPED_TEST(SlowStandstill, EndsARunThatNoLongerAdvances) {
  using T = typename TypeParam::Scalar;
  Wall<T> wall{T(0)};
  wall.restitution = T(1) / T(2);
  const Scene<T> pair = list<T>({T(1), T(2)}, {T(0), T(-1)}, {T(1), T(1000)});
  const auto walled = std::make_shared<Walled<T>>(pair, wall, std::nullopt);
  const SpeedDependent<T> law(T(9) / T(10), T(1) / T(100), T(2));
  Simulation run(law, GapChain<T, IndividualMasses<T>>(walled, T(0)), Policy<T>{});
  EXPECT_EQ(run.advance(T(1000)), Status::exhausted);
  EXPECT_LE(run.counts().collisions, 1200000U);
}

}  // namespace standstill_wide_test
