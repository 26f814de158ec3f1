// The watch over the two heaviest clusters: what counts as a meeting, a pass, a stick, a change of roles; and exponents
// of a pair whose path is known. Given the collisions of a made-up shock, and those of a run against a count by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::scenario_test {

using Regime = Scenario::Regime;

Cloud<double> pair(ParticleIndex left, ParticleIndex right, double mass = 100, double separation = 1) {
  Cloud<double> c;
  c.left = Cluster<double>{mass, -separation / 2, 0.1, left};
  c.right = Cluster<double>{mass, separation / 2, -0.1, right};
  c.mass = 2.5 * mass;
  return c;
}

TEST(Scenario, NoPairWhileClustersAreSmall) {
  ScenarioWatch watch;
  watch.sample(pair(3, 5, 9), 1, 0);
  Cloud<double> thin = pair(3, 5, 20);
  thin.mass = 80;  // they hold no more than half of it
  watch.sample(thin, 2, 0);
  watch.collision(3, 5, 2.5, 0);
  const Scenario found = watch.result(1);
  EXPECT_EQ(found.regime, Regime::none);
  EXPECT_EQ(found.sticks, 0U);
  EXPECT_TRUE(std::isnan(found.established));
}

TEST(Scenario, PassesSticksAndChangesOfRoles) {
  ScenarioWatch watch;
  watch.sample(pair(3, 5), 10, 40);
  EXPECT_EQ(watch.result(40).regime, Regime::apart);
  watch.collision(3, 7, 11, 40);  // with a third one: no meeting
  watch.collision(3, 5, 12, 41);
  watch.collision(8, 9, 13, 41);  // none merged in between: they have passed
  EXPECT_EQ(watch.result(41).passes, 1U);
  EXPECT_EQ(watch.result(41).regime, Regime::through);
  watch.sample(pair(5, 3), 14, 42);  // on exchanged sides: the same pair
  EXPECT_EQ(watch.result(42).role_changes, 0U);
  watch.collision(5, 3, 15, 42);
  watch.sample(pair(3, 11), 16, 43);  // one merge: they have stuck, another cluster is second now
  const Scenario found = watch.result(43);
  EXPECT_EQ(found.established, 10);
  EXPECT_EQ(found.first_meeting, 12);
  EXPECT_TRUE(found.first_passed);
  EXPECT_EQ(found.passes, 1U);
  EXPECT_EQ(found.sticks, 1U);
  EXPECT_EQ(found.role_changes, 1U);
  EXPECT_EQ(found.regime, Regime::stuck);
  watch.collision(3, 11, 20, 50);
  EXPECT_EQ(watch.result(50).regime, Regime::through);
  watch.sample(pair(3, 12), 21, 50);
  EXPECT_EQ(watch.result(50).regime, Regime::apart);  // this pair has not met
}

TEST(Scenario, ExponentsOfAKnownPath) {
  ScenarioWatch watch;
  for (int k = 0; k < 4000; ++k) {
    const double t = std::pow(10, 1 + 5.0 * k / 4000), swing = std::sin(40 * std::cbrt(t));
    Cloud<double> c = pair(3, 5, 100, std::cbrt(t) * std::abs(swing));
    c.left->v = std::cos(40 * std::cbrt(t)) / std::cbrt(t);
    c.right->v = -c.left->v;
    watch.sample(c, t, 0);
  }
  const Scenario found = watch.result(0);
  EXPECT_NEAR(found.separation_exponent, 1.0 / 3, 0.02);  // the maximum of a bin lies anywhere in it
  EXPECT_NEAR(found.speed_exponent, -1.0 / 3, 0.02);
  EXPECT_EQ(found.role_changes, 0U);
}

// Fig. 11's shock to t = 1e5: meetings counted from the configurations before and after every collision of the pair.
TEST(Scenario, OfARunAsCountedByHand) {
  Simulation run(Wet<double>{0.05}, ClusterChain<double>{rshock<double>(200000), 0.0});
  ScenarioWatch watch;
  std::uint64_t passes = 0, sticks = 0, meetings = 0;
  Cloud<double> before;
  for (int k = 0; k <= 600; ++k) {
    const double t = std::pow(10, 1 + 4.0 * k / 600);
    const bool known = k > 0 && !std::isnan(watch.result(run.counts().merges).established);
    const auto observe = [&](const Collision<double>& c) {
      watch.collision(c.left, c.right, c.time.value(), run.counts().merges);
      meetings += known && std::minmax(c.left, c.right) == std::minmax(before.left->index, before.right->index);
    };
    ASSERT_EQ(run.advance(t, observe), Status::reached);
    const auto now = cloud(run.configuration(t));
    if (known) {  // between two samples the pair mostly meets once at most
      const bool kept =
          std::minmax(now.left->index, now.right->index) == std::minmax(before.left->index, before.right->index);
      passes += kept && now.left->index == before.right->index;
      sticks += !kept && std::max(now.left->mass, now.right->mass) >= before.left->mass + before.right->mass;
    }
    watch.sample(now, t, run.counts().merges);
    before = now;
  }
  const Scenario found = watch.result(run.counts().merges);
  EXPECT_EQ(found.passes + found.sticks, meetings);
  EXPECT_EQ(found.sticks, sticks);
  EXPECT_GE(found.passes, passes);
  EXPECT_EQ((found.passes - passes) % 2, 0U);  // an even number goes unseen
}

}  // namespace cradle::test::scenario_test
