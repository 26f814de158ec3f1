// Gaps and absolute positions of the same particles make the same collisions, of rows and cold gases of any masses for
// long. (At another time of the start: engine/collapse_policy_test.cpp. What must not change a bit is in
// engine/same_bits_test.cpp; a loop without a queue makes the same collisions in precision/random_scenes_test.cpp, an
// exact gas in precision/exact_gas_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::twins_test {

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps) = 311.
const Inelastic<double> law(0.98, 1e-5);

// In the same order, with the same state to rounding.
template <class First, class Second>
void expect_same_collisions(First gaps, Second positions, double end, std::uint64_t least_collisions) {
  EXPECT_EQ(sequence_to(gaps, end), sequence_to(positions, end));
  EXPECT_TRUE(same_collisions(gaps.counts(), positions.counts()));
  const auto a = configuration_at(gaps, end), b = configuration_at(positions, end);
  EXPECT_LE(largest_difference(a.x, b.x), 4e-11);
  EXPECT_LE(largest_difference(a.v, b.v), 4e-11 / end);
  EXPECT_LE(largest_difference(a.gap, b.gap), 4e-11);
  EXPECT_GT(gaps.counts().collisions, least_collisions);
  EXPECT_EQ(gaps.chain().account().order_lost, 0U);
  EXPECT_EQ(positions.chain().account().unresolved, 0U) << "positions no longer show which collision comes first";
}

// A particle makes up to 400 collisions. In positions each rounds the place (|x| < 256, so by 2^-46 at most in every
// one of two operations) and the velocity, by some 2^-53 that then acts for 250 units of time: 400 (2 * 1.4e-14 + 250 *
// 2.2e-16) < 4e-11 if all roundings had the same sign.
TEST(Twins, GapsAndPositionsMakeTheSameCollisions) {
  const auto rows = rshock<double>(400), mixed = rmix<double>(300);
  expect_same_collisions(gap_run(rows, law), position_run(rows, law), 250, 20000);
  expect_same_collisions(mass_run(unequal_rows(), law), position_run(unequal_rows(), law), 170, 15000);
  expect_same_collisions(gap_run(mixed, law), position_run(mixed, law), 100, 5000);
  for (const auto& masses : {unequal_rows<double>({}, three_masses), cold_gas(32, HotPlace::middle)})
    expect_same_collisions(mass_run(masses, law), position_run(masses, law), 100, 400);
}

}  // namespace cradle::test::twins_test
