// The dense core of a shock: against its definition on particles placed by hand, and particle by particle on random
// ones.
#include "cradle/core/observe/configuration_statistics.hpp"

#include <random>

#include <gtest/gtest.h>

#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::dense_core_test {

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

}  // namespace cradle::test::dense_core_test
