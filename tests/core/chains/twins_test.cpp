// Compares every way of holding the same particles. Proves: gaps and absolute positions make the same collisions, and
// so does a loop without a queue. A chain that streams its rows and one that holds them completely have the same bits,
// and so have runs with output once, ten times or ten thousand times, with and without an observer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cradle/tests/core/chains/twins.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace twins_test {

using namespace cradle;
using namespace cradle::test;

// With rows of speed 1/2 collapse sets in at t = 2/(1 - (4/pi) atan sqrt eps).
const Inelastic<double> law(0.98, 1e-5);    // t = 311
const Inelastic<double> softer(0.9, 1e-3);  // t = 60

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0;
  for (std::size_t j = 0; j < a.size(); ++j) largest = std::max(largest, std::abs(a[j] - b[j]));
  return largest;
}

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
  const auto particles = rshock<double>(400);
  expect_same_collisions(gap_run(particles, law), position_run(particles, law), 10, 250, 4e-11, 20000);
}

TEST(Twins, GapsAndPositionsMakeTheSameCollisionsWithUnequalRowsAndACentralMass) {
  const auto particles = unequal_rows();
  expect_same_collisions(mass_run(particles, law), position_run(particles, law), 10, 170, 4e-11, 15000);
}

TEST(Twins, GapsAndPositionsMakeTheSameCollisionsInAMixedGas) {
  const auto particles = rmix<double>(300);
  expect_same_collisions(gap_run(particles, Inelastic<double>(0.98, 1e-5)),
                         position_run(particles, Inelastic<double>(0.98, 1e-5)), 5, 100, 4e-11, 5000);
}

TEST(Twins, QueueAndPlainSearchMakeTheSameCollisions) {
  const auto particles = rshock<double>(400);
  auto run = gap_run(particles, law);
  Sequence of_run, of_loop;
  run.advance(150, [&](const Collision<double>& c) { of_run.add(c.left); });
  SlowLoop loop(law, GapChain<double>(particles, 0, true));
  for (std::uint64_t n = 0; n < run.counts().collisions; ++n) {
    const auto s = loop.next();
    ASSERT_TRUE(s.has_value());
    of_loop.add(loop.collide(*s).particle);
  }
  EXPECT_TRUE(of_run == of_loop);
}

TEST(Twins, StreamedAndHeldRowsHaveTheSameBits) {
  const auto particles = rshock<double>(200);
  auto streamed = gap_run(particles, softer);
  auto held = gap_run(particles, softer, {}, 0., {.hold_all = true});
  // Beyond the collapse, and beyond the ends of the rows.
  for (double t = 2.5; t <= 250; t += 2.5) expect_identical(streamed, held, t, CloseCalls::the_same);
  EXPECT_EQ(streamed.chain().collided_particles(), 200);
  EXPECT_GT(streamed.counts().below_cutoff, 0U);
}

TEST(Twins, RowsAndTheSameParticlesInAListHaveTheSameBits) {
  const auto rows = rshock<double>(200);
  auto streamed = gap_run(rows, softer);
  auto listed = gap_run(as_list(*rows), softer);
  for (double t = 2.5; t <= 100; t += 2.5) expect_identical(streamed, listed, t, CloseCalls::the_same);
}

TEST(Twins, StreamedAndHeldUnequalRowsHaveTheSameBits) {
  const auto particles = unequal_rows();
  auto streamed = mass_run(particles, law);
  auto held = mass_run(particles, law, {}, 0., {.hold_all = true});
  for (double t = 12.5; t <= 500; t += 12.5) expect_identical(streamed, held, t, CloseCalls::the_same);
  EXPECT_GT(streamed.chain().collided_particles(), 300);
}

TEST(Twins, OutputCadenceDoesNotChangeABit) {
  expect_no_influence_of_cadence([] { return gap_run(rshock<double>(200), softer); }, 100);
}

TEST(Twins, OutputAtTheVeryTimeOfACollisionDoesNotChangeABit) {
  const Inelastic<double> soft(0.9375, 0);
  const auto particles = rmix<double>(32);
  expect_no_influence_of_output_at_collisions(gap_run(particles, soft), gap_run(particles, soft), 100, 101);
}

// Rows displaced by a few 2^-28, so that collisions all along the line are nearly simultaneous, and keys too wide to
// decide which comes first: output between them must not change the run.
TEST(Twins, OutputBetweenNearlySimultaneousCollisionsDoesNotChangeABit) {
  for (const ParticleIndex count : {100, 200, 300}) {
    for (ParticleIndex seed = 0; seed < 20; ++seed) {
      const Scene<double> particles = std::make_shared<Rows<double>>(symmetric_rows<double>(
          count, 0.5, 1, [seed](ParticleIndex particle) { return bits_of(particle + 1000 * seed, 0, 0xF) - 8; }));
      SCOPED_TRACE(seed);
      const auto make = [&] { return gap_run(particles, law, {}, 0., {.least_queue_bits = 18}); };
      expect_no_influence_of_output_at_collisions(make(), make(), 0.75 * static_cast<double>(count), 0);
    }
  }
}

TEST(Twins, ObserverDoesNotChangeABit) {
  const auto particles = rshock<double>(400);
  expect_no_influence_of_an_observer(gap_run(particles, law), gap_run(particles, law), 200);
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
    EXPECT_TRUE(identical(configuration_at(in_turn[k], end), configuration_at(side_by_side[k], end)));
    EXPECT_TRUE(identical(in_turn[k].counts(), side_by_side[k].counts()));
  }
}

}  // namespace twins_test
