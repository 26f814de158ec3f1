// Steps in double-double (core/parallel/steps/pairs.inl). Proves: runs in segments with steps have the bits of the
// plain loop: both doubles of every gap, closing speed, local time, lag and loss, and every collision that is observed;
// on lines, rows and rings, with equal and unequal masses, between walls, on lattices, on 1, 2, 3 and 8 threads. Nearly
// all collisions of gases are made in steps.
//
// As steps_cases.cpp it is built with errors planted too, and must fail with each of them.
#include "cradle/precision/double_double.hpp"
#include "cradle/tests/core/parallel/steps/ways.hpp"

namespace cradle::test::steps_of_pairs_test {

using T = double_double;
using Equal = GapChain<T>;
using Unequal = GapChain<T, IndividualMasses<T>>;

T part(int numerator, int denominator) { return T(numerator) / T(denominator); }

class StepsOfPairs : public ::testing::Test {
  void SetUp() override {
    if (fastest_steps() == nullptr) GTEST_SKIP() << "no vectors of four lanes";
  }
};

TEST_F(StepsOfPairs, RowsThatAreStreamed) { expect_same_by_all_laws<Equal>(rshock<T>(1200), {420, 424}, 0.25); }
TEST_F(StepsOfPairs, GasOnALine) { expect_same_by_all_laws<Equal>(gas<T>(800), {1, 60}, 0.25); }
TEST_F(StepsOfPairs, GasOnARing) { expect_same_by_all_laws<Equal>(gas<T>(700, T(700)), {10, 40}, 0.25); }
TEST_F(StepsOfPairs, UnequalMassesOnALine) {
  expect_same_by_all_laws<Unequal>(gas<T>(700, T(0), true), {10, 60}, 0.25);
}
TEST_F(StepsOfPairs, UnequalMassesOnARing) {
  expect_same_by_all_laws<Unequal>(gas<T>(700, T(700), true), {10, 40}, 0.25);
}
// Collisions are simultaneous all over the line: for the event loop.
TEST_F(StepsOfPairs, LatticesFullOfTies) { expect_same_by_all_laws<Equal>(lattice_rows<T>(900), {310}, 0); }
TEST_F(StepsOfPairs, Walls) {
  expect_same_between_walls<Equal>({8, 40}, 0.25);
  expect_same_between_walls<Unequal>({40}, 0.25);
}
TEST_F(StepsOfPairs, LeaveColumnsAndShakenWallsToTheEventLoop) { expect_same_at_curved_walls<Equal>({120}, 0); }

TEST_F(StepsOfPairs, MakeNearlyAllCollisionsOfAGas) {
  const SlabsMade made =
      expect_same_in_steps<Equal>(gas<T>(3000), Inelastic<T>(part(999, 1000), part(1, 100'000)), {20, 40, 60, 80},
                                  {{{.gaps = 700, .anywhere = true, .steps = fastest_steps()}, 2}});
  EXPECT_GT(made.slabs, 4U);
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

// Dense and cold: what is out of order is found and made again.
TEST_F(StepsOfPairs, MakeThemAgainWhereImpulsesRunFar) {
  std::vector<T> x, v;
  std::mt19937_64 random(1);
  T place(0);
  for (int i = 0; i < 1500; ++i) {
    const bool dense = i / 100 % 5 == 2;
    place += T(static_cast<std::int64_t>(random() >> 40)) / T(1 << (dense ? 30 : 23));
    x.push_back(place);
    v.push_back(T(static_cast<std::int64_t>(random() >> 40)) / T(1 << (dense ? 27 : 23)));
  }
  const SlabsMade made = expect_same_in_steps<Equal>(list(x, v), Inelastic<T>(T(1)), {1, 2, 5, 20}, all_ways());
  EXPECT_GT(made.in_steps, 1000U);
}

TEST_F(StepsOfPairs, SlowFigure2) {
  const SlabsMade made = expect_same_in_steps<Equal>(rshock<T>(8000), Inelastic<T>(part(999, 1000), part(1, 100'000)),
                                                     {4000}, {{{.steps = fastest_steps()}, 2}});
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

TEST_F(StepsOfPairs, RandomScenes) { expect_same_in_random_scenes<Equal, Unequal>(39); }

}  // namespace cradle::test::steps_of_pairs_test
