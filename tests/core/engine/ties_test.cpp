// The order of collisions that the queue's keys cannot distinguish, hundreds of them at a time: it is (exact time,
// position in the line) among all of them, so that no bit depends on the width of keys. The gases are on a lattice,
// near the elastic limit: particles at integers with integer speeds, where many collisions are within the resolution of
// a key. The factor 1 - eps separates them, from exactly simultaneous to what a key resolves.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/strict_real.hpp"

namespace ties_test {

using namespace cradle;
using namespace cradle::test;

constexpr ParticleIndex particles = 1000;
constexpr double end = 20;

// Speeds -1, 0 and 1 by chance.
template <class T> Scene<T> lattice(ParticleIndex n, ParticleIndex seed) {
  std::vector<T> x, v;
  for (ParticleIndex i = 0; i < n; ++i) {
    x.push_back(T(i));
    v.push_back(T(static_cast<std::int64_t>(hash(i + 1000000 * seed) % 3) - 1));
  }
  return list(std::move(x), std::move(v));
}

template <class A, class B> void expect_identical(const A& a, const B& b) {
  EXPECT_TRUE(identical(configuration_at(a, end), configuration_at(b, end)));
  EXPECT_TRUE(same_collisions(a.counts(), b.counts()));
  EXPECT_EQ(a.counts().origin_moves, b.counts().origin_moves);
  EXPECT_EQ(a.energy_lost(), b.energy_lost());
  EXPECT_EQ(a.account().simultaneous, b.account().simultaneous);
  EXPECT_EQ(a.account().order_lost, b.account().order_lost);
}

TEST(Ties, WidthOfTheIndexDoesNotChangeABitOfTwelveLattices) {
  for (const double dissipation : {1e-6, 1e-12, 1e-14})
    for (const ParticleIndex seed : {1, 2, 3, 4}) {
      const auto scene = lattice<double>(particles, seed);
      const auto run = [&](int bits) {
        auto of_width = gap_run(scene, Inelastic<double>(1 - dissipation), {}, 0., {.least_queue_bits = bits});
        EXPECT_EQ(of_width.advance(end), Status::reached);
        return of_width;
      };
      const auto narrow = run(3);
      EXPECT_GT(narrow.counts().close_calls, narrow.counts().collisions / 20) << "nothing to decide here";
      for (const int bits : {13, 17, 20, seed == 1 ? 23 : 11}) {
        SCOPED_TRACE(testing::Message() << "1 - eps = " << dissipation << ", seed " << seed << ", " << bits << " bits");
        expect_identical(narrow, run(bits));
      }
    }
}

TEST(Ties, WidthOfTheIndexDoesNotChangeABitWhereParticlesPassAndMerge) {
  for (const ParticleIndex seed : {1, 2, 3}) {
    const auto scene = lattice<double>(particles, seed);
    const auto run = [&](int bits) {
      Simulation of_width(Wet<double>(1e-9), ClusterChain<double>(scene, 0.), Policy<double>{}, bits);
      EXPECT_EQ(of_width.advance(end), Status::reached);
      return of_width;
    };
    const auto narrow = run(3);
    for (const int bits : {14, 20}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << bits << " bits");
      expect_identical(narrow, run(bits));
    }
  }
}

// Against the plainest way: all gaps are searched before each collision.
template <class T> void expect_each_the_first(ParticleIndex n, const T& restitution, int bits) {
  const auto scene = lattice<T>(n, 5);
  auto run = gap_run<T>(scene, Inelastic<T>(restitution), {}, T(0), {.least_queue_bits = bits});
  const auto& chain = run.chain();
  run.advance(T(10), [&](const Collision<T>& collision) {
    Slot first = 0;
    for (Slot s = chain.first(); s <= chain.last(); ++s)
      if (chain.closing(s) > T(0) && (first == 0 || chain.due(s) < chain.due(first))) first = s;
    ASSERT_EQ(chain.particle(first), collision.left) << "collision " << run.counts().collisions;
  });
  EXPECT_GT(run.counts().collisions, static_cast<std::uint64_t>(3 * n));
}

TEST(Ties, EveryCollisionIsTheFirstByTimeAndThenFromTheLeft) {
  for (const int bits : {3, 18}) {
    expect_each_the_first<double>(500, 1, bits);
    expect_each_the_first<double>(500, 1 - 1e-12, bits);
  }
}
TEST(Ties, EveryCollisionIsTheFirstWhereKeysAreRounded) {
  expect_each_the_first<StrictReal>(300, StrictReal(1), 16);
  expect_each_the_first<StrictReal>(300, StrictReal::of(1 - 1e-12), 16);
}

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
  Simulation run(Inelastic<double>(1), Counted(lattice<double>(many, 1), 0.));
  Counted::looks = 0;
  ASSERT_EQ(run.advance(2), Status::reached);
  ASSERT_GT(run.counts().collisions, 16000U);
  EXPECT_LT(Counted::looks, 8 * run.counts().collisions);
}

}  // namespace ties_test
