// The front of the wet shock in a run, against the tracer's recursion r_{n+1} = r_n/2 + sqrt(r_n^2/4 - e), r = u + u0,
// which is exact until the turnover (paper, section V): rows on a lattice at plus and minus u0 = 1/2, in every scalar
// type to its full precision.
//
// Tolerance. A collision multiplies an error of r by at most 1 + e/r^2, r >= 1/2: over n collisions by less than 2 for
// the losses here (n e/r^2 of order 1); the law rounds some 8 times, so r_n is off by 16 n u, flights l/r by as much of
// themselves, places by their sum: 32 (n + 1)(t + 1) u.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/theory/wet_shock.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::wet_front_test {

template <class P> using WetFront = test::InPrecision<P>;
TYPED_TEST_SUITE(WetFront, test::EveryPrecision, test::PrecisionName);

template <class T> void expect_front(const T& loss, std::uint64_t turnover, int samples) {
  Simulation run(Wet<T>{loss}, ClusterChain<T>{lattice_rows<T>(static_cast<ParticleIndex>(4 * turnover)), T(0)});
  theory::WetFrontRecursion<T> front(theory::WetShock<T>{loss});
  const auto end = theory::turnover_collision(theory::WetShock<T>{loss});
  ASSERT_TRUE(end);
  ASSERT_EQ(end->collision, turnover);
  const T unit = T(std::numeric_limits<T>::epsilon());
  for (int k = 1; k <= samples; ++k) {
    const T t = T(1) + (end->time - T(1)) * T(k) / T(samples);
    ASSERT_EQ(run.advance(t), Status::reached);
    front.advance_to(t);
    const auto expected = front.position_at(t);
    ASSERT_TRUE(expected);
    const T tolerance = T(32) * T(static_cast<std::int64_t>(front.now().collision + 1)) * (t + T(1)) * unit;
    ASSERT_LE(magnitude(T(run.front_right(t) - *expected)), tolerance) << to_double(t);
    ASSERT_LE(magnitude(T(run.front_left(t) + *expected)), tolerance) << to_double(t);
  }
  EXPECT_EQ(run.account().order_lost, 0U);
}

TYPED_TEST(WetFront, FollowsTheRecursion) {
  using T = typename TestFixture::Scalar;
  expect_front<T>(T(1) / T(100), 38, 97);
  expect_front<T>(T(1) / T(20), 8, 31);
}

TEST(WetFrontInDouble, FollowsTheRecursionForThousandsOfCollisions) { expect_front(1e-4, 3750, 50); }

}  // namespace cradle::test::wet_front_test
