// The order of collisions that the queue's keys cannot distinguish, hundreds of them at a time: it is (exact time,
// position in the line) among all of them, so that no bit depends on the width of keys. The gases are on a lattice,
// near the elastic limit: particles at integers with integer speeds, where many collisions are within the resolution of
// a key. The factor 1 - eps separates them, from exactly simultaneous to what a key resolves. (That no bit depends on
// the width is in same_bits_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/core/strict_real.hpp"

namespace cradle::test::ties_test {

template <class T> void expect_each_the_first(ParticleIndex n, const T& restitution, int bits) {
  cradle::test::expect_each_the_first(
      gap_run<T>(crowds<T>(n, 5), Inelastic<T>(restitution), {}, T(0), {.least_queue_bits = bits}), T(10),
      static_cast<std::uint64_t>(3 * n) + 1);
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
  Simulation run(Inelastic<double>(1), Counted(crowds<double>(many, 1), 0.));
  Counted::looks = 0;
  ASSERT_EQ(run.advance(2), Status::reached);
  ASSERT_GT(run.counts().collisions, 16000U);
  EXPECT_LT(Counted::looks, 8 * run.counts().collisions);
}

}  // namespace cradle::test::ties_test
