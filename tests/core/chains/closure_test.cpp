// The closure error with laws by which particles merge or pass. Proves: it is measured while both rows have particles
// that have not collided, whose flights are known, and on a ring; later there is no number. (That it is 0 in exact
// arithmetic: precision/exact_gas_test.cpp; that positions and sticky gases have none: tools/run/run_test.cpp.) Two
// threads may read a chain at once.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::closure_test {

// The distance of the outermost particles seen minus the sum of the gaps between, in long double: as velocities are 1/2
// and times short, the places are exact in it, and n gaps add up to n/2 units of 2^-64 times their sum.
TEST(Closure, IsMeasuredWhileRowsLast) {
  const auto rows = rshock<double>(20000);
  Simulation run(Wet<double>(0.05), ClusterChain<double>(rows, 0.));
  double largest = 0;
  for (double t = 250; t <= 8000; t += 250) {
    ASSERT_EQ(run.advance(t), Status::reached);
    const auto c = run.configuration(t);
    ASSERT_TRUE(c.closure_gap.has_value()) << t;
    EXPECT_FALSE(c.closure_speed.has_value()) << "closing speeds are differences of velocities";
    const auto place = [&](ParticleIndex b) {
      return static_cast<long double>(rows->position(b)) + static_cast<long double>(rows->velocity(b)) * t;
    };
    long double missing = place(c.to) - place(c.from), way = 0;
    for (const double gap : c.gap) way += gap;
    missing -= way;
    const double rounding = static_cast<double>(static_cast<long double>(c.gap.size() + 2) * 0x1p-64L * way);
    EXPECT_NEAR(*c.closure_gap, static_cast<double>(missing), rounding) << t;
    largest = std::max(largest, std::abs(*c.closure_gap));
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(largest, 1e-10);
}

TEST(Closure, IsNoNumberOnceBothRowsAreUsedUp) {
  Simulation run(Wet<double>(0.05), ClusterChain<double>(rshock<double>(100), 0.));
  run.advance(400);
  EXPECT_FALSE(run.configuration(400).closure_gap.has_value());
}

TEST(Closure, IsMeasuredOnARing) {
  Simulation run(Wet<double>(0.1), ClusterChain<double>(gaussian_ring(200, 200), 0.));
  run.advance(30);
  const auto c = run.configuration(30);
  long double way = 0;
  for (const double gap : c.gap) way += gap;
  ASSERT_TRUE(c.closure_gap.has_value());
  EXPECT_NEAR(*c.closure_gap, static_cast<double>(200 - way), 200 * std::numeric_limits<double>::epsilon());
  EXPECT_FALSE(c.closure_speed.has_value());
}

// Reading is const and means it: under ThreadSanitizer a cache that two readers fill is a race.
TEST(Reading, ByTwoThreadsAtOnce) {
  for (const Scene<double>& particles : {gaussian_ring(200, 200), rshock<double>(100)}) {
    Simulation run(Wet<double>(0.05), ClusterChain<double>(particles, 0.));
    run.advance(400);
    Configuration<double> seen[2];
    std::thread other([&] { seen[1] = run.configuration(400); });
    seen[0] = run.configuration(400);
    other.join();
    EXPECT_TRUE(identical(seen[0], seen[1]));
  }
}

}  // namespace cradle::test::closure_test
