// Velocities that are drawn several at once, against the same method one number after the other.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "cradle/core/initial/velocities.hpp"

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

}  // namespace cradle::test::velocities_test
