// Gaps and absolute positions of the same particles make the same collisions, of rows and cold gases of any masses for
// long; positions also in a run that starts at another time. (What must not change a bit is in
// engine/same_bits_test.cpp; a loop without a queue makes the same collisions in precision/filtered_queue_test.cpp, an
// exact gas in precision/exact_gas_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::twins_test {

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps) = 311.
const Inelastic<double> law(0.98, 1e-5);

// Runs both to each time in turn, the second one later by `start`: same collisions in the same order, same state to
// rounding.
template <class First, class Second>
void expect_same_collisions(First first, Second second, double step, double end, double tolerance,
                            std::uint64_t least_collisions, double start = 0) {
  Sequence of_first, of_second;
  for (double t = step; t <= end; t += step) {
    ASSERT_EQ(first.advance(t, [&](const Collision<double>& c) { of_first.add(c.left); }), Status::reached);
    ASSERT_EQ(second.advance(start + t, [&](const Collision<double>& c) { of_second.add(c.left); }), Status::reached);
    ASSERT_TRUE(same_collisions(first.counts(), second.counts())) << "t = " << t;
    ASSERT_TRUE(of_first == of_second) << "t = " << t;
    const auto a = configuration_at(first, t), b = configuration_at(second, start + t);
    ASSERT_LE(largest_difference(a.x, b.x), tolerance) << "t = " << t;
    ASSERT_LE(largest_difference(a.v, b.v), tolerance / end) << "t = " << t;
    ASSERT_LE(largest_difference(a.gap, b.gap), tolerance) << "t = " << t;
  }
  EXPECT_GT(first.counts().collisions, least_collisions);
  EXPECT_EQ(first.chain().account().order_lost, 0U);
  EXPECT_EQ(second.chain().account().unresolved, 0U) << "positions no longer show which collision comes first";
}

// A particle makes up to 400 collisions. In positions each rounds the place (|x| < 256, so by 2^-46 at most in every
// one of two operations) and the velocity, by some 2^-53 that then acts for 250 units of time: 400 (2 * 1.4e-14 + 250 *
// 2.2e-16) < 4e-11 if all roundings had the same sign.
TEST(Twins, GapsAndPositionsMakeTheSameCollisions) {
  const auto rows = rshock<double>(400), mixed = rmix<double>(300);
  expect_same_collisions(gap_run(rows, law), position_run(rows, law), 10, 250, 4e-11, 20000);
  expect_same_collisions(mass_run(unequal_rows(), law), position_run(unequal_rows(), law), 10, 170, 4e-11, 15000);
  expect_same_collisions(gap_run(mixed, law), position_run(mixed, law), 5, 100, 4e-11, 5000);
  for (const auto& masses : {unequal_rows<double>({}, three_masses), cold_gas(32, HotPlace::middle)})
    expect_same_collisions(mass_run(masses, law), position_run(masses, law), 10, 100, 4e-11, 400);
}

// Times up to 1100 are rounded by 1.2e-13, the rest as above: 400 (2 * 1.4e-14 + 250 * 2.2e-16 + 2 * 1.2e-13) = 1.3e-10
// at most.
TEST(Twins, PositionsMakeTheSameCollisionsLater) {
  const auto rows = rshock<double>(200);
  const Inelastic<double> soft(0.9, 1e-3);
  for (const double start : {-100., -3.5, 10., 1000.}) {
    SCOPED_TRACE(start);
    expect_same_collisions(gap_run(rows, soft), position_run(rows, soft, {}, start), 60, 60, 1.3e-10, 1000, start);
  }
}

}  // namespace cradle::test::twins_test
