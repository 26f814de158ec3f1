// Absolute positions in runs that do not start at t = 0. Proves: a run that starts at another time is the same run
// later, to the rounding of absolute times: the same collisions, the first interval from the start, and under policy
// stop the same collapse.
#include <gtest/gtest.h>

#include <cmath>

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::positions_test {

constexpr double starts[] = {-100, -3.5, 10, 1000};

struct Seen {
  Sequence collisions;
  std::vector<double> intervals;
};
template <class Run> Seen advance(Run& run, double until) {
  Seen seen;
  run.advance(until, [&](const Collision<double>& c) {
    seen.collisions.add(c.left);
    seen.intervals.push_back(c.interval);
  });
  return seen;
}

// eps = 0.05: the three particles on the left collapse.
TEST(Positions, PolicyStopFindsTheCollapseWheneverTheRunStarts) {
  const auto particles = list<double>({0, 1, 3, 10}, {1, 0, -1, 5});
  const auto run_from = [&](double start) {
    return position_run<double>(particles, Inelastic<double>(0.05), {.collapse = CollapsePolicy::stop}, start);
  };
  auto first = run_from(0);
  ASSERT_NE(first.advance(100), Status::reached);
  ASSERT_TRUE(first.collapse().settled);
  for (const double start : starts) {
    SCOPED_TRACE(start);
    auto later = run_from(start);
    const Seen seen = advance(later, start + 100);
    ASSERT_EQ(later.chain().account().order_lost, 0U);
    EXPECT_NEAR(seen.intervals.at(0), 1, 4e-16 * std::abs(start));
    ASSERT_TRUE(later.collapse().settled);
    EXPECT_NEAR(later.collapse().time.value() - start, first.collapse().time.value(),
                first.collapse().uncertainty + later.collapse().uncertainty);
  }
}

// A particle makes up to 400 collisions; times up to 1100 are rounded by 1.2e-13, positions and velocities as in
// Twins.GapsAndPositionsMakeTheSameCollisions: 400 (2 * 1.4e-14 + 250 * 2.2e-16 + 2 * 1.2e-13) = 1.3e-10 at most if all
// roundings had the same sign.
TEST(Positions, TheSameRunLater) {
  const auto particles = rshock<double>(200);
  const Inelastic<double> law(0.9, 1e-3);
  auto gaps = gap_run(particles, law);
  const Seen seen = advance(gaps, 60);
  const auto expected = gaps.configuration(60);
  for (const double start : starts) {
    SCOPED_TRACE(start);
    auto run = position_run(particles, law, {}, start);
    ASSERT_TRUE(advance(run, start + 60).collisions == seen.collisions);
    EXPECT_TRUE(same_collisions(run.counts(), gaps.counts()));
    const auto c = run.configuration(start + 60);
    EXPECT_EQ(c.index, expected.index);
    EXPECT_LE(largest_difference(c.x, expected.x), 1.3e-10);
    EXPECT_LE(largest_difference(c.v, expected.v), 1.3e-10);
  }
}

}  // namespace cradle::test::positions_test
