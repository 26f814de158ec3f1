// Compares every way of holding the same particles, dry and wet. Proves: gaps and absolute positions make the same
// collisions. Runs side by side do not change a bit. (What else must not change one is in engine/same_bits_test.cpp; a
// loop without a queue makes the same collisions in precision/filtered_queue_test.cpp.)
#include <gtest/gtest.h>

#include <vector>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/reference_gas.hpp"

namespace cradle::test::twins_test {

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps).
const Inelastic<double> law(0.98, 1e-5);    // t = 311
const Inelastic<double> softer(0.9, 1e-3);  // t = 60

// Runs both to each time in turn: same collisions in the same order, same state to rounding.
template <class First, class Second>
void expect_same_collisions(First first, Second second, double step, double end, double tolerance,
                            std::uint64_t least_collisions) {
  Sequence of_first, of_second;
  for (double t = step; t <= end; t += step) {
    ASSERT_EQ(first.advance(t, [&](const Collision<double>& c) { of_first.add(c.left); }), Status::reached);
    ASSERT_EQ(second.advance(t, [&](const Collision<double>& c) { of_second.add(c.left); }), Status::reached);
    ASSERT_TRUE(same_collisions(first.counts(), second.counts())) << "t = " << t;
    ASSERT_TRUE(of_first == of_second) << "t = " << t;
    const auto a = configuration_at(first, t), b = configuration_at(second, t);
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

TEST(Twins, StepsOfSeveralRunsSideBySideDoNotChangeABit) {
  constexpr double end = 150;
  std::vector<GapRun<double>> in_turn, side_by_side;
  for (const ParticleIndex count : {200, 300}) {
    in_turn.push_back(gap_run(rshock<double>(count), softer));
    side_by_side.push_back(gap_run(rshock<double>(count), softer));
    ASSERT_EQ(in_turn.back().advance(end), Status::reached);
  }
  for (auto& run : side_by_side) run.head_for(end);
  for (bool going[2] = {true, true}; going[0] || going[1];)
    for (std::size_t k : {0U, 1U}) going[k] = going[k] && side_by_side[k].step();
  for (std::size_t k : {0U, 1U}) {
    EXPECT_EQ(side_by_side[k].status(), Status::reached);
    expect_same_state(in_turn[k], side_by_side[k], end);
    EXPECT_EQ(in_turn[k].counts().close_calls, side_by_side[k].counts().close_calls);
  }
}

// In absolute positions, the next collision found by looking at every pair. With 50 digits neither side's rounding,
// 1e-50, shows within some 1e20 of amplification, which 500 collisions are far from; a wrong collision would be off by
// orders of the spacing.
TEST(Twins, WetGapsAndPositionsMakeTheSameCollisions) {
  using Wide = Digits<50>;
  const auto mass = [](ParticleIndex i) { return Wide(1 + bits_of(i, 40, 7)) / Wide(4); };
  const auto on_line = as_list(*rmix<Wide>(60), mass);
  for (const double loss : {.0025, 0.025, .25}) {
    SCOPED_TRACE(loss);
    Simulation run(Wet<Wide>{Wide(loss)}, ClusterChain<Wide>(on_line, Wide(0)));
    auto twin = gas_like(*on_line);
    twin.law = GasLaw::wet, twin.loss = Wide(loss);
    for (int t = 10; t <= 120; t += 10) {
      ASSERT_EQ(run.advance(Wide(t)), Status::reached);
      twin.advance(Wide(t));
      ASSERT_EQ(run.counts().collisions, twin.collisions) << t;
      ASSERT_EQ(run.counts().merges, twin.merges) << t;
      const auto c = run.configuration(Wide(t));
      ASSERT_EQ(c.from, 0);
      ASSERT_EQ(c.to, 59);
      ASSERT_EQ(c.x.size(), twin.cells.size());
      for (std::size_t j = 0; j < c.x.size(); ++j) {
        const auto& cell = twin.cells[j];
        ASSERT_EQ(c.index[j], cell.particles.front()) << t;
        ASSERT_EQ(c.m[j], cell.m) << t;
        ASSERT_LE(abs(c.x[j] - twin.place(cell)), Wide(1e-30)) << t << ", particle " << c.index[j];
        ASSERT_LE(abs(c.v[j] - twin.velocity(cell)), Wide(1e-30)) << t << ", particle " << c.index[j];
      }
    }
    EXPECT_GT(run.counts().collisions, 60U);
    EXPECT_GT(run.counts().merges, 10U);
  }
}

}  // namespace cradle::test::twins_test
