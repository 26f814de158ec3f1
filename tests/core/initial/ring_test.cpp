// The initial state of free cooling on a ring. (Motion on rings: precision/exact_gas_test.cpp; what is no ring:
// engine/misuse_test.cpp.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::ring_test {

TEST(Ring, StartsWithZeroMomentumAndTheRequestedVariance) {
  constexpr ParticleIndex n = 200000;
  for (const bool gaussian : {true, false}) {
    const Ring<double> ring(n, 2.0 * n, 0.5, gaussian ? gaussian_velocity(7, 3) : uniform_velocity(7, 3),
                            uniform_displacement(0.25, 7, 3));
    double momentum = 0, fourth = 0, gaps = 0, closing = 0, least = 1e9;
    for (ParticleIndex b = 0; b < n; ++b) {
      const double v = ring.velocity(b);
      momentum += v;  // multiples of 2^-29, below 2^53 of them: exact
      fourth += v * v * v * v;
      gaps += ring.gap(b);
      closing += ring.closing_speed(b);
      least = std::min(least, ring.gap(b));
      if (b + 1 < n) {
        EXPECT_NEAR(ring.gap(b), ring.position(b + 1) - ring.position(b), 1e-10);
      }
    }
    EXPECT_EQ(momentum, 0);
    EXPECT_EQ(closing, 0);
    EXPECT_NEAR(gaps, 2.0 * n, 1e-8);
    EXPECT_GT(least, 0);
    // Five standard errors of variance (kurtosis k): sqrt((k - 1)/n) of it, and of the fourth moment likewise.
    const double kurtosis = gaussian ? 3 : 1.8, sixth_over = gaussian ? 105 : 9;  // <v^8>/s^8: 105, 81/9
    EXPECT_NEAR(2 * ring.kinetic_energy() / n, 0.25, 5 * 0.25 * std::sqrt((kurtosis - 1) / n));
    EXPECT_NEAR(fourth / n, kurtosis / 16, 5 * std::sqrt((sixth_over - kurtosis * kurtosis) / n) / 16);
  }
}

TEST(Ring, PortableLogarithm) {
  for (double x = 1; x > 1e-19; x *= 0.77) EXPECT_NEAR(detail::portable_log(x), std::log(x), 4e-16 * -std::log(x)) << x;
}

}  // namespace cradle::test::ring_test
