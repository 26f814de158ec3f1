// When a run ends because it no longer advances, in types with any range of exponents. Proves: the number of collisions
// at one time since the start is bounded. The bound ends a collapse that tends to that time, but not one that a cut-off
// ends below the clock's resolution. Particles of restitution 0 that
// meet at one time separate by a cut-off, after as many collisions as in exact rationals.
#include <gtest/gtest.h>

#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::standstill_test {

// Reviews at which offsets from a moving origin advance, and the time since the start does not.
std::uint64_t collisions_until_it_ends(std::uint64_t active, double followed = 1) {
  Standstill<double> standstill(0, false, followed);
  double local = 1;
  for (std::uint64_t collisions = 1; collisions < 3000000; ++collisions, local *= 1.00001)
    if (standstill.at(local, 1, collisions, active)) return collisions;
  return 0;
}

TEST(Standstill, CollisionsAtOneTimeHaveABound) {
  EXPECT_EQ(collisions_until_it_ends(2), 1U + (1U << 20) + 4096U * 4U + 1U);
  EXPECT_EQ(collisions_until_it_ends(3), 1U + (1U << 20) + 4096U * 9U + 1U);
  EXPECT_EQ(collisions_until_it_ends(1000), 0U) << "many particles may have billions";
  EXPECT_EQ(collisions_until_it_ends(2, 1e300), collisions_until_it_ends(2)) << "also on the way to a small gap";
}

TEST(Standstill, IsOverWhereTheTimeSinceTheStartAdvances) {
  Standstill<double> standstill(0);
  constexpr std::uint64_t million = 1000000;
  EXPECT_FALSE(standstill.at(1, 1, million, 2));
  EXPECT_FALSE(standstill.at(2, 1, 2 * million, 2));
  standstill.epoch_ended(0, 1.5, 2 * million);
  EXPECT_FALSE(standstill.at(3, 1.5, 3 * million, 2));
  EXPECT_TRUE(standstill.at(4, 1.5, 3 * million + (1 << 20), 2));
}

// Three particles whose speeds fall to 1e-280 at t = 12/7, 700 collisions long, and who then part.
TEST(Standstill, ACutOffBelowTheClocksResolutionIsReached) {
  auto run = gap_run(three_particles(), Inelastic<double>(0.05, 1e-110));
  EXPECT_EQ(run.advance(100), Status::reached);
  EXPECT_GT(run.counts().below_cutoff, 0U);
}

// Ten particles that meet at one time and stay in touch: 9 to 0.001 evened out by collisions from the left. In exact
// numbers they end; more of them than particles without a threshold may have.
template <class T> std::uint64_t collisions_where_all_meet(int particles) {
  std::vector<T> x, v;
  for (int particle = 0; particle < particles; ++particle) x.push_back(T(particle)), v.push_back(T(-particle));
  auto run = gap_run(list<T>(x, v), Inelastic<T>(T(0), T(1) / T(1000)));
  EXPECT_EQ(run.advance(T(2)), Status::reached);
  EXPECT_EQ(run.last_collision_time(), T(1));
  return run.counts().collisions;
}
TEST(Standstill, ParticlesInTouchPartByACutOff) {
  EXPECT_EQ(collisions_where_all_meet<double>(5), collisions_where_all_meet<Rational>(5));
  EXPECT_GT(collisions_where_all_meet<double>(10), 64U + 4U * 100U);
  auto without = gap_run(list<double>({0, 1, 2}, {0, -1, -2}), Inelastic<double>(0));
  EXPECT_EQ(without.advance(2), Status::exhausted) << "they never do";
}

}  // namespace cradle::test::standstill_test
