// Keyed random numbers. Proves: Philox4x32-10 gives the known answers of the Random123 distribution (kat_vectors;
// Salmon et al., SC'11, doi 10.1145/2063384.2063405, who tested that its numbers are uniform and unrelated), with the
// seed as its key, replica and index as its counter; uniform_integer is within its bounds and as equal as it says.
// (States made of them, in every scalar type: precision/random_states_test.cpp.)
#include <gtest/gtest.h>

#include <ranges>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle::test::counter_rng_test {

using Words = std::array<std::uint32_t, 4>;

TEST(CounterRng, KnownAnswers) {
  constexpr std::uint32_t ones = 0xFFFFFFFF;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(CounterRng, KeyIsTheSeedAndCounterIsIndexAndReplica) {
  constexpr std::uint64_t seed = 0x299f31d0a4093822, index = 0x85a308d3243f6a88, replica = 0x0370734413198a2e;
  EXPECT_EQ(random_bits(seed, replica, index), 0x94fdccebd16cfe09U);
  static_assert(random_bits(0, 0, 0) == 0xe169c58d6627e8d5, "known when compiling");
}

TEST(CounterRng, UniformIntegerReachesItsBoundsAndNoFurther) {
  for (const std::int64_t bound : {std::int64_t{0}, std::int64_t{1}, std::int64_t{12345}, (std::int64_t{1} << 27) - 1,
                                   (std::int64_t{1} << 31) - 1}) {
    EXPECT_EQ(uniform_integer(0, bound), -bound);
    EXPECT_EQ(uniform_integer(~std::uint64_t{0}, bound), bound);
    for (std::uint64_t i = 0; i < 10000; ++i) {
      ASSERT_GE(uniform_integer(random_bits(7, 0, i), bound), -bound);
      ASSERT_LE(uniform_integer(random_bits(7, 0, i), bound), bound);
    }
  }
}

// Rising in its argument, so each value has one run of arguments: found by bisection, counted exactly.
TEST(CounterRng, UniformIntegerIsAsEqualAsItSays) {
  const auto first_argument = [](std::int64_t value, std::int64_t bound) {
    const auto arguments = std::views::iota(std::uint64_t{0}, ~std::uint64_t{0});
    return *std::ranges::lower_bound(arguments, value, {}, [=](auto bits) { return uniform_integer(bits, bound); });
  };
  for (const std::int64_t bound : {std::int64_t{1}, std::int64_t{50}, std::int64_t{13421772}}) {
    const double share = std::ldexp(1, 64) / static_cast<double>(2 * bound + 1);
    const std::int64_t step = std::max<std::int64_t>(1, bound / 50);
    for (std::int64_t value = -bound; value < bound; value += step) {
      const std::uint64_t count = first_argument(value + 1, bound) - first_argument(value, bound);
      // Unequal by 2^-32 of all arguments at most, which is the 2^32 of them that the low product rounds off.
      ASSERT_NEAR(static_cast<double>(count), share, std::ldexp(1, 32)) << value << " of " << bound;
    }
  }
}

TEST(CounterRng, DisplacementsStayWithinThePerturbation) {
  const Displacement displacement = uniform_displacement(0.05, 1, 0);
  std::int64_t least = 0, greatest = 0;
  for (ParticleIndex b = 0; b < 100000; ++b) {
    least = std::min(least, displacement(b));
    greatest = std::max(greatest, displacement(b));
  }
  const auto bound = static_cast<std::int64_t>(0.05 * static_cast<double>(displacement_unit));
  EXPECT_GE(least, -bound);
  EXPECT_LE(greatest, bound);
  // Of 1e5 the outermost is within 1e-3 of the bound but for a probability of e^-50.
  EXPECT_LT(least, -bound + bound / 1000);
  EXPECT_GT(greatest, bound - bound / 1000);
  for (ParticleIndex b = 0; b < 100; ++b) EXPECT_EQ(uniform_displacement(0, 1, 0)(b), 0);
  EXPECT_THROW(uniform_displacement(-0.1, 1, 0), std::invalid_argument);
}

}  // namespace cradle::test::counter_rng_test
