// The order of collisions. Made out of order on purpose, in exact arithmetic: proves that two collisions on either side
// of a gap commute exactly, since a gap's local time never decreases. If the gap between them should have closed in
// between, the violation is counted at that gap; its collision is then due in the past, and is not clamped.
//
// Collisions that the queue's keys cannot distinguish, thousands of them at a time: proves that they are not sorted
// anew for every collision. (That their order is by exact times, and then from the left, is in
// precision/filtered_queue_test.cpp; that no bit depends on the width of keys in same_bits_test.cpp.)
//
// Collisions that follow each other at one time and place, where particles touch: proves that they are those of the
// exact system, as long as double represents the closing speeds; otherwise, if collisions are within rounding of each
// other, no order is reported as lost. Local times that a late collision leaves ahead of the origin lose nothing when
// it moves. Collisions that are later than rounding explains are still counted.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/segmented.hpp"

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

// ---- particles that restitution 0 leaves together, with gap 0 and closing speed 0, until another one hits them

// Particles on a ring with velocities in units of 2^-12 and displacements in units of 2^-12, the second half of them
// moving as the first one does but the other way, so that there is no mean to take off.
template <class T> Scene<T> coarse_ring(ParticleIndex count, ParticleIndex seed) {
  const auto velocity = [=](ParticleIndex b) {
    const bool mirrored = b >= count / 2;
    const std::int64_t v = (bits_of((mirrored ? count - 1 - b : b) + 1000 * seed, 20, 0x1FFF) - 4096) << 16;
    return mirrored ? -v : v;
  };
  const auto displacement = [=](ParticleIndex b) { return (bits_of(b + 77 * seed, 30, 0x7FF) - 1024) << 16; };
  return std::make_shared<Ring<T>>(count, T(count), T(1), velocity, displacement);
}

// At every particle the collisions that it has had, by closing speeds.
template <class T> auto collisions_of_particles(const Scene<T>& ring, const T& cutoff, const T& until) {
  std::vector<std::vector<std::pair<ParticleIndex, Rational>>> of(static_cast<std::size_t>(ring->count()));
  auto run = gap_run(ring, Inelastic<T>(T(0), cutoff));
  const auto status = run.advance(until, [&](const Collision<T>& c) {
    for (const ParticleIndex particle : {c.left, c.right})
      of[static_cast<std::size_t>(particle)].emplace_back(c.left, Rational(c.closing_speed));
  });
  EXPECT_EQ(status, Status::reached);
  EXPECT_EQ(run.account().order_lost, 0U);
  return std::pair(of, run.counts().collisions);
}

TEST(Touching, ParticlesAreHitAsInTheExactSystem) {
  std::uint64_t collisions = 0;
  for (const ParticleIndex count : {4, 8, 12})
    for (ParticleIndex seed = 1; seed <= 16; ++seed) {
      const auto exact = collisions_of_particles(coarse_ring<Rational>(count, seed), Rational(1, 8), Rational(20));
      const auto rounded = collisions_of_particles(coarse_ring<double>(count, seed), 0.125, 20.);
      EXPECT_EQ(rounded.first, exact.first) << count << " particles, seed " << seed;
      collisions += exact.second;
    }
  EXPECT_GT(collisions, 2000U);
}

// Halving after halving closing speeds outgrow double, and particles that the exact system keeps together part by
// roundings.
TEST(Touching, CollisionsWithinRoundingAreInNoWrongOrder) {
  for (const double restitution : {0., 1e-6})
    for (const double cutoff : {.001, .1})
      for (const ParticleIndex count : {10, 50})
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
          auto run = gap_run<double>(gaussian_ring(count, static_cast<double>(count), seed, 0),
                                     Inelastic<double>(restitution, cutoff));
          run.advance(200);
          EXPECT_EQ(run.account().order_lost, 0U) << restitution << ", " << cutoff << ", " << count << ", " << seed;
          EXPECT_TRUE(restitution > 0 || run.account().simultaneous > 0);
        }
}

TEST(Touching, AWindowInSegmentsIsThatOfThePlainLoop) {
  expect_same_in_segments<GapChain<double>>(gaussian_ring(600, 600, 1, 0), Inelastic<double>(0, 0.1), segmentations(),
                                            {5., 30.});
}

// 2^30/3 - 1/10 is no double, and what is lost is not: at the next move it belongs to another local time.
TEST(Touching, ALocalTimeAheadOfTheOriginLosesNothing) {
  TimedGaps<double, Gap<double>> gaps(0, 1);
  gaps.resize(1);
  gaps.put(0, {{1, 0x1p30 / 3}, 1});
  const auto move = [&](double by) { gaps.move_origin(by, [](const auto& each) { each(0, 1); }); };
  move(0.1);
  const double now = 0x1p29;
  gaps.kick(
      0, 1., [] { return 1.; }, now);
  move(now + 1);
  EXPECT_EQ(gaps.flown(0, 0), 1);
}

// The middle particle's collisions, in the wrong order: the left one is due earlier by so many units of rounding than
// the right one, after which the origin moves.
std::uint64_t orders_lost(double units) {
  const double late = units * std::numeric_limits<double>::epsilon();
  const auto particles = list<double>({-1 + late, 0, 1}, {1, 0, -1});
  GapChain<double> chain(particles, 0);
  const Inelastic<double> law(0);
  const auto strike = [&](Slot s) {
    const double time = chain.due(s);
    chain.collide(law, s, time);
    chain.move_origin(time);
  };
  const Slot left = chain.first(), right = left + 1;
  strike(right);
  for (int collisions = 0; collisions < 20; ++collisions) {  // the one that is due first, if any is
    const Slot s = chain.queue_due(left) < chain.queue_due(right) ? left : right;
    if (chain.queue_due(s) < EventQueue::never) strike(s);
  }
  return chain.account().order_lost;
}

// A time before the move is rounded by half a unit, another after it by less. 16 are allowed.
TEST(Touching, LaterThanRoundingIsCountedOnceTheOriginHasMoved) {
  for (const double units : {0., 0.5, 1., 2.}) EXPECT_EQ(orders_lost(units), 0U) << units;
  for (const double units : {100., 1e6, 1e12}) EXPECT_EQ(orders_lost(units), 1U) << units;
}

}  // namespace cradle::test::order_test
