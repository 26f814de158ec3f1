// Velocities that are drawn several at once, against the same method one number after the other; and what the initial
// state of free cooling on a ring makes of them. (Motion on rings: precision/exact_gas_test.cpp; what is no ring:
// engine/misuse_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/initial/velocities.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::velocities_test {

// Marsaglia's polar method for one particle: the square of the radius and the velocity, if it is not rejected.
std::optional<std::pair<double, std::int64_t>> polar(std::uint64_t bits) {
  const double u = (static_cast<double>(bits >> 32) + 0.5) * 0x1p-31 - 1;
  const double v = (static_cast<double>(bits & 0xFFFFFFFF) + 0.5) * 0x1p-31 - 1, square = u * u + v * v;
  if (square >= 1) return {};
  const double normal = u * std::sqrt(-2 * detail::portable_log(square) / square);
  return std::pair(square, static_cast<std::int64_t>(std::floor(normal * 0x1p28 + 0.5)));
}
std::int64_t one_gaussian(std::uint64_t seed, std::uint64_t replica, ParticleIndex particle) {
  for (std::uint64_t attempt = 1;; ++attempt)
    if (const auto drawn = polar(random_bits(seed, replica, static_cast<std::uint64_t>(particle) | attempt << 56)))
      return drawn->second;
}

TEST(Velocities, AreThoseThatAreDrawnOneByOne) {
  const std::uint64_t large = 0xFEDCBA9876543210;
  for (const auto& [seed, replica] : {std::pair<std::uint64_t, std::uint64_t>{1, 0}, {large, ~large}})
    for (const ParticleIndex first : {ParticleIndex{0}, (ParticleIndex{1} << 31) - 5000})
      for (const ParticleIndex count : {0, 1, 2, 3, 4, 5, 7, 4999}) {
        const std::vector<std::int64_t> all = drawn(gaussian_velocity(seed, replica), first, count);
        for (ParticleIndex k = 0; k < count; ++k)
          ASSERT_EQ(all[static_cast<std::size_t>(k)], one_gaussian(seed, replica, first + k)) << first << " " << k;
      }
}

TEST(Velocities, UniformOnesDoNotDependOnTheFirstParticle) {
  const std::vector<std::int64_t> all = drawn(uniform_velocity(3, 4), 0, 100),
                                  part = drawn(uniform_velocity(3, 4), 90, 10);
  for (std::size_t k = 0; k < part.size(); ++k) EXPECT_EQ(part[k], all[90 + k]);
}

// Numbers at the ends of the range, which no draw of a test comes to.
TEST(Velocities, OfAllBitsAreExact) {
  namespace lanes = detail::lanes;
  for (const std::uint64_t all :
       {0x80000000'80000000, 0x7FFFFFFF'80000000u, 0x80000000'00000001, 0xB504F333'7FFFFFFF}) {
    const lanes::Polar of = lanes::polar(lanes::Words{} + all);
    EXPECT_EQ(of.square[0], polar(all)->first);
    EXPECT_EQ(of.velocity[0], polar(all)->second);
  }
}

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

}  // namespace cradle::test::velocities_test
