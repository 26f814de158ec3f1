// Measurements of a gas with clusters: the two heaviest, the cloud, the distribution of masses, the width of the
// interaction zone, and what becomes of the two heaviest; the dense core of a shock, against its definition on
// particles placed by hand, and particle by particle on random ones.
#include <gtest/gtest.h>

#include <random>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::clusters_test {

Configuration<double> five_clusters() {
  Configuration<double> c = placed({-4, -1, 0, 2, 5}, {1, -1, 0, 2, -1}, {9, 3, 1, 5, 20});
  c.collided_to = 4;  // the last one has not collided
  return c;
}

TEST(Cloud, TwoHeaviestOfThoseThatHaveCollided) {
  const Cloud<double> found = cloud(five_clusters());
  ASSERT_TRUE(found.left && found.right);
  EXPECT_EQ(found.left->mass, 9);
  EXPECT_EQ(found.left->index, 0);
  EXPECT_EQ(found.right->mass, 5);
  EXPECT_EQ(found.right->x, 2);
  EXPECT_EQ(found.right->v, 2);
  EXPECT_EQ(found.mass, 18);
  // Of masses 3 at -1 and 1 at 0: mean -3/4, variance (3/16 + 9/16)/4 = 3/16.
  EXPECT_DOUBLE_EQ(found.width * found.width, 3.0 / 16);
}

TEST(Cloud, NoneBeforeTheFirstCollision) {
  Configuration<double> c = five_clusters();
  c.collided_to = 0;
  const Cloud<double> found = cloud(c);
  EXPECT_FALSE(found.left || found.right);
  EXPECT_EQ(found.mass, 0);
}

TEST(Masses, BinsAreQuarterPowersOfTwo) {
  const auto clusters = mass_distribution(five_clusters(), 1.0);  // masses 9, 3, 1, 5
  ASSERT_EQ(clusters.size(), 13U);                                // 2^(12/4) = 8 <= 9 < 2^(13/4)
  EXPECT_EQ(clusters[0], 1U);
  EXPECT_EQ(clusters[6], 1U);  // 2.83 <= 3 < 3.36
  EXPECT_EQ(clusters[9], 1U);  // 4.76 <= 5 < 5.66
  EXPECT_EQ(clusters[12], 1U);

  // A thousand and 24 masses of 0.1 are 2^10 of the least mass, though their sum is rounded to less.
  Configuration<double> one = five_clusters();
  one.collided_from = 0, one.collided_to = 1;
  one.m[0] = 0;
  for (int k = 0; k < 1024; ++k) one.m[0] += 0.1;
  EXPECT_LT(one.m[0], 102.4);
  const auto found = mass_distribution(one, 0.1);
  ASSERT_EQ(found.size(), 41U);
  EXPECT_EQ(found[40], 1U);
}

// Right-movers placed such that u+ falls linearly from u0 at x = -2 to 0 at x = 2, and their mirror image: 2L = 4. Bins
// of 1/4 with particles at their centres make the interpolation exact.
TEST(Zone, WidthOfALinearFall) {
  const List<double> nobody({-100, 100}, {0, 0});
  ZoneAverage zone(4, 32, 16, 1);
  for (int k = 0; k < 16; ++k) {
    Configuration<double> c;
    c.to = 1;
    const auto add = [&](double x, double v, double m) { c.x.push_back(x), c.v.push_back(v), c.m.push_back(m); };
    for (int bin = 0; bin < 32; ++bin) {
      const double x = -4 + (bin + 0.5) / 4, right = std::clamp(0.5 * (2 - x) / 4, 0.0, 0.5),
                   left = std::clamp(0.5 * (2 + x) / 4, 0.0, 0.5);
      if (right > 0) add(x, right, 1);
      if (left > 0) add(x, -left, 1);
      add(x, 0.01, 50);  // a cluster is none of them
    }
    zone.find(c, nobody, 0.0);
    zone.add_found();
  }
  EXPECT_NEAR(zone.width(0.5, 0).width, 4, 1e-12);
  EXPECT_NEAR(zone.width(0.5, 0).error, 0, 1e-12);
  EXPECT_NEAR(zone.width(0.5, 0.1).width, 4 * 0.8, 1e-12);  // u0 to u_crit only
  EXPECT_DOUBLE_EQ(zone.density_right()[0], 4);
  EXPECT_DOUBLE_EQ(zone.velocity_right()[0], 0.5);
  EXPECT_DOUBLE_EQ(zone.mass_density()[0], 4 * 51);
}

// Rows that nothing slows down have no zone; and particles that no front has reached are seen.
TEST(Zone, NoWidthWithoutAFall) {
  const auto rows = rshock<double>(200);
  Simulation run(Wet<double>{0.0}, ClusterChain<double>(rows, 0.0));
  ZoneAverage zone(10, 20, 16, 1);
  for (int k = 1; k <= 16; ++k) {
    const double time = 5.0 + k / 2.0;
    ASSERT_EQ(run.advance(time), Status::reached);
    zone.find(run.configuration(time), *rows, time);
    zone.add_found();
  }
  EXPECT_TRUE(std::isnan(zone.width(0.5, 0).width));
  EXPECT_NEAR(zone.velocity_right()[0], 0.5, 1e-12);
  EXPECT_NEAR(zone.density_right()[3], 1, 0.13);  // one per length, 16 samples of one bin
  EXPECT_THROW(ZoneAverage(0, 20, 16, 1), std::invalid_argument);
}

// ---- the watch over the two heaviest: what counts as a meeting, a pass, a stick, a change of roles; exponents of a
// pair whose path is known. Given the collisions of a made-up shock, and those of a run against a count by hand.

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

// ---- the dense core

TEST(DenseCore, IsTheShortestHalfAndAsMuchOnEitherSide) {
  // 15 particles, 8 of which are more than half: 0 to 7 of the eleven that are 1 apart.
  Configuration<double> c =
      placed({-60, -50, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 50, 60}, {99, 99, 5, 4, 3, 2, 1, 0, 1, 2, 3, 4, 6, 99, 99});
  DenseCore core = dense_core(c);
  EXPECT_EQ(core.width, 7);
  EXPECT_EQ(core.mass, 11);
  EXPECT_EQ(core.velocity_range, 6);
  EXPECT_EQ(core.gap, 1);
  // One particle in twenty to either side is no part of the velocity range.
  std::vector<double> x, v;
  for (int k = 0; k < 100; ++k) x.push_back(k), v.push_back(k < 4 ? -50 : k >= 96 ? 50 : 0.01 * k);
  core = dense_core(placed(x, v));
  EXPECT_EQ(core.mass, 100);  // the shortest half, 0 to 50, and as much to its right
  EXPECT_NEAR(core.velocity_range, 0.90, 1e-12);
  // Only particles that have collided count.
  c.collided_from = 12, c.collided_to = 15;
  EXPECT_EQ(dense_core(c).width, 10);
}

TEST(DenseCore, CountsMass) {
  const DenseCore core = dense_core(placed({0, 1, 2, 10}, {1, 2, 3, 4}, {1, 1, 1, 100}));
  EXPECT_EQ(core.width, 0);
  EXPECT_EQ(core.mass, 100);
  EXPECT_EQ(core.velocity_range, 0);
  EXPECT_TRUE(std::isnan(core.gap));
  EXPECT_TRUE(std::isnan(dense_core(placed({1}, {1})).width));
}

TEST(DenseCore, IsAsWideAsGapsSay) {
  Configuration<double> c = placed({0, 1, 1, 1, 1, 2}, {0, 1e-3, 2e-3, 3e-3, 4e-3, 0});
  std::fill(c.gap.begin() + 1, c.gap.begin() + 4, 1e-20);
  const DenseCore core = dense_core(c);
  EXPECT_DOUBLE_EQ(core.width, 3e-20);
  EXPECT_EQ(core.gap, 1e-20);
}

TEST(DenseCore, OfRandomParticlesIsThatOfItsDefinition) {
  std::mt19937_64 random(5);
  std::uniform_int_distribution<int> step(1, 50), mass(1, 3), count(2, 60);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> x, v, m;
    double at = 0, all = 0;
    for (int particles = count(random); particles > 0; --particles) {
      x.push_back(at += step(random) * (random() % 3 == 0 ? 1 : 0.0625));
      v.push_back(step(random)), m.push_back(mass(random));
      all += m.back();
    }
    double shortest = x.back() - x.front(), from = x.front(), inside = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = i; j < x.size(); ++j) {
        double held = 0;
        for (std::size_t b = i; b <= j; ++b) held += m[b];
        if (held > all / 2 && x[j] - x[i] < shortest) shortest = x[j] - x[i], from = x[i];
      }
    std::vector<double> velocities;  // once for each unit of mass
    for (std::size_t b = 0; b < x.size(); ++b)
      if (x[b] >= from - shortest && x[b] <= from + 2 * shortest)
        inside += m[b], velocities.insert(velocities.end(), static_cast<std::size_t>(m[b]), v[b]);
    std::sort(velocities.begin(), velocities.end());
    const auto at_share = [&](double share) {
      return velocities[static_cast<std::size_t>(std::ceil(share * inside)) - 1];
    };
    const DenseCore core = dense_core(placed(x, v, m));
    ASSERT_EQ(core.width, shortest);
    ASSERT_EQ(core.mass, inside);
    ASSERT_EQ(core.velocity_range, at_share(0.95) - at_share(0.05));
  }
}

}  // namespace cradle::test::clusters_test
