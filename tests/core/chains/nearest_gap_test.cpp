// The smaller gap beside a collision, which is used to detect collapse. Proves: in every chain it is the smaller of the
// gaps between the colliding particles and their neighbours, also after a merger, when the cell of the collision holds
// the gap on the right.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace cradle::test::nearest_gap_test {

// Particles 1 and 2 meet at t = 1, at 2: the neighbours, at rest, are 7 and 3 away, and 1/4 beyond the right one is
// another.
Scene<double> five_particles() { return list<double>({-5, 1, 3, 5, 5.25}, {0, 1, -1, 0, 0}); }

template <class Law, class Chain> double beside_first_collision(Law law, Chain chain) {
  SlowLoop loop(law, chain);
  return loop.collide(loop.next().value()).nearest_gap;
}

TEST(NearestGap, AfterABounceOrAPass) {
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), GapChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), PositionChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Inelastic<double>(0.5), ClusterChain<double>(five_particles(), 0.)), 3);
  EXPECT_EQ(beside_first_collision(Wet<double>(0.125), ClusterChain<double>(five_particles(), 0.)), 3);
}

TEST(NearestGap, AfterAMerger) {
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(five_particles(), 0.)), 3);
  // At an end of the line there is the one neighbour; with none, nothing is near.
  const auto three = list<double>({0, 1, 3}, {1, 0, 0}), two = list<double>({0, 1}, {1, 0});
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(three, 0.)), 2);
  EXPECT_EQ(beside_first_collision(Sticky<double>{}, ClusterChain<double>(two, 0.)), far_away<double>());
}

}  // namespace cradle::test::nearest_gap_test
