// Measurements of a gas with clusters: the two heaviest, the cloud, the distribution of masses, and the width of the
// interaction zone.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/observe/placed.hpp"

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

}  // namespace cradle::test::clusters_test
