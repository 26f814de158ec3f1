// The order of collisions. Made out of order on purpose, in exact arithmetic: proves that two collisions on either side
// of a gap commute exactly, since a gap's local time never decreases. If the gap between them should have closed in
// between, the violation is counted at that gap; its collision is then due in the past, and is not clamped.
//
// Collisions that the queue's keys cannot distinguish, thousands of them at a time: proves that they are not sorted
// anew for every collision. (That their order is by exact times, and then from the left, is in
// precision/filtered_queue_test.cpp; that no bit depends on the width of keys in same_bits_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::order_test {

// Gaps 0 and 2 close at t = 1 and `late` at closing speed 1; the gap between them is `between` wide and at rest.
Scene<Rational> four_particles(const Rational& late, const Rational& between) {
  return list<Rational>({-1, 0, between, between + late}, {1, 0, 0, -1});
}

const Inelastic<Rational> half(Rational(1, 2), Rational(0));

template <class Chain> void collide(Chain& chain, ParticleIndex gap) {
  const Slot s = chain.first() + static_cast<Slot>(gap);
  chain.collide(half, s, chain.due(s));
}

// The state after the collisions at the given gaps, in that order; every gap and closing speed, every position.
template <class Chain> auto state_after(const Scene<Rational>& particles, std::initializer_list<ParticleIndex> gaps) {
  Chain chain(particles, Rational(0));
  for (const ParticleIndex gap : gaps) collide(chain, gap);
  const auto c = chain.configuration(Rational(3));
  EXPECT_EQ(chain.account().order_lost, 0U);
  return std::tuple(c.gap, c.closing_speed, c.x, c.v);
}

TEST(Order, CollisionsEitherSideOfAGapCommute) {
  const auto particles = four_particles(Rational(6, 5), Rational(10));
  using Gaps = GapChain<Rational>;
  using Masses = GapChain<Rational, IndividualMasses<Rational>>;
  using Clusters = ClusterChain<Rational>;
  EXPECT_EQ((state_after<Gaps>(particles, {0, 2})), (state_after<Gaps>(particles, {2, 0})));
  EXPECT_EQ((state_after<Masses>(particles, {0, 2})), (state_after<Masses>(particles, {2, 0})));
  EXPECT_EQ((state_after<Clusters>(particles, {0, 2})), (state_after<Clusters>(particles, {2, 0})));
  EXPECT_EQ((state_after<Gaps>(particles, {0, 2})), (state_after<PositionChain<Rational>>(particles, {0, 2})));
  EXPECT_EQ((state_after<Gaps>(particles, {0, 2})), (state_after<Clusters>(particles, {0, 2})));
}

// After the collision at t = 1 the gap between, 3/200 wide, closes at speed 3/4, at t = 1.02; the collision on its
// other side at t = 1.2 comes first here. As of that time the gap is -27/200: it should have closed.
TEST(Order, AViolationIsDetectedAndCounted) {
  const auto expect_counted = [](auto chain) {
    collide(chain, 2);
    EXPECT_EQ(chain.account().order_lost, 0U);
    collide(chain, 0);
    EXPECT_EQ(chain.account().order_lost, 1U);
    EXPECT_EQ(chain.account().first_order_lost.particle, 1);
    EXPECT_EQ(chain.account().first_order_lost.gap, Rational(-27, 200));
    // Both neighbours have handed it 3/4: due at 6/5 - (27/200)/(3/2).
    EXPECT_EQ(chain.due(chain.first() + 1), Rational(111, 100));
    EXPECT_EQ(chain.account().simultaneous, 0U);
  };
  const auto particles = four_particles(Rational(6, 5), Rational(3, 200));
  expect_counted(GapChain<Rational>(particles, Rational(0)));
  expect_counted(ClusterChain<Rational>(particles, Rational(0)));
}

// ---- ties

// The work: a crowd of k collisions takes some k log k comparisons of exact times, not k^2.
class Counted : public GapChain<double> {
 public:
  using GapChain<double>::GapChain;
  double due(Slot s) const {
    ++looks;
    return GapChain<double>::due(s);
  }
  static inline std::uint64_t looks = 0;
};
TEST(Ties, ACrowdOfThousandsIsNotSortedAnewForEveryCollision) {
  constexpr ParticleIndex many = 20000;  // some 4000 simultaneous collisions at t = 1/2
  Simulation run(Inelastic<double>(1), Counted(crowds<double>(many, 1), 0.));
  Counted::looks = 0;
  ASSERT_EQ(run.advance(2), Status::reached);
  ASSERT_GT(run.counts().collisions, 16000U);
  EXPECT_LT(Counted::looks, 8 * run.counts().collisions);
}

}  // namespace cradle::test::order_test
