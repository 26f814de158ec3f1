// Steps of wet particles (core/parallel/steps/wet.inl). Proves: runs in segments with steps have the bits of the plain
// loop: every gap, velocity, mass, local time and lag, counts and losses, and every collision that is observed; on
// lines, rows and rings, with equal and unequal masses, on 1, 2, 3 and 8 threads, where few particles merge and where
// nearly all do. Nearly all collisions are made in steps.
//
// As steps_cases.cpp it is built with errors planted too, and must fail with each of them.
#include "cradle/core/laws/one_of.hpp"
#include "cradle/tests/core/parallel/steps/ways.hpp"

namespace cradle::test::wet_steps_test {

using Chain = ClusterChain<double>;
using Law = Wet<double>;

class WetSteps : public WithSteps {};

void expect_same(const Scene<double>& scene, const std::vector<int>& times, const std::vector<double>& losses,
                 double least_in_steps = 0.9) {
  std::vector<SegmentsAs> ways = all_ways();
  for (const SegmentsAs& as : on_all_vectors({.anywhere = true}, 1)) ways.push_back(as);
  for (const double loss : losses) {
    SCOPED_TRACE("loss " + std::to_string(loss));
    const SlabsMade made = expect_same_in_steps<Chain>(scene, Law(loss), times, ways);
    EXPECT_GT(made.slabs, 50U);
    EXPECT_GE(static_cast<double>(made.in_steps), least_in_steps * static_cast<double>(made.collisions));
  }
}

TEST_F(WetSteps, MakeRowsThatAreStreamed) { expect_same(rshock<double>(1400), {500, 520, 560}, {2e-4, 2e-5}); }
TEST_F(WetSteps, MakeAGasOnALine) { expect_same(gas<double>(800), {1, 100, 160}, {0.02, 2e-4}); }
TEST_F(WetSteps, MakeAGasOnARing) { expect_same(gas<double>(700, 700.), {2, 10, 60}, {0.02, 2e-4}); }
TEST_F(WetSteps, MakeUnequalMassesOnALine) { expect_same(gas<double>(700, 0., true), {10, 100}, {0.02, 2e-4}); }
TEST_F(WetSteps, MakeUnequalMassesOnARing) { expect_same(gas<double>(700, 700., true), {2, 10, 60}, {0.02, 2e-4}); }
// Collisions are simultaneous all over the line: for the event loop.
TEST_F(WetSteps, LatticesFullOfTies) { expect_same(lattice_rows(900), {310}, {2e-4}, 0); }

// As programs have it: one of several laws. The others have no steps.
TEST_F(WetSteps, MakeOneOfSeveralLaws) {
  using Several = OneOf<Law, Sticky<double>>;
  for (const bool sticky : {false, true}) {
    const Several law = sticky ? Several(Sticky<double>()) : Several(Law(0.001));
    const SlabsMade made =
        expect_same_in_steps<Chain>(gas<double>(900), law, {20}, on_all_vectors({.anywhere = true}, 1));
    EXPECT_EQ(made.in_steps > 0, !sticky);
  }
}

// Time slabs in which many particles merge: cells fall vacant in long rows, and what a step leaves to the next one is
// listed once.
TEST_F(WetSteps, MakeACoolingGasInWhichNearlyAllMerge) {
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const SlabsMade made = expect_same_in_steps<Chain>(gaussian_ring(8000, 8000, seed, 0), Law(0.1), {1000},
                                                       {{{.collisions = 8, .steps = &all_steps().front()}, 2}});
    EXPECT_GT(static_cast<double>(made.in_steps), 0.9 * static_cast<double>(made.collisions));
  }
}

// Dense and cold in parts, where a fast particle passes through many others: what is out of order is found and made
// again.
TEST_F(WetSteps, MakeThemAgainWhereParticlesRunFar) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> speed;
  std::vector<double> x, v;
  double place = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool dense = i / 100 % 5 == 2;
    place += (0.5 + static_cast<double>(random() >> 11) * 0x1p-53) / (dense ? 300 : 1);
    x.push_back(place);
    v.push_back(speed(random) / (dense ? 30 : 1));
  }
  const SlabsMade made =
      expect_same_in_steps<Chain>(list(x, v), Law(1e-7), {3, 20}, on_all_vectors({.gaps = 500, .anywhere = true}, 2));
  EXPECT_GT(made.in_steps, 10'000U);
}

TEST_F(WetSteps, SlowFigure6) {
  const SlabsMade made = expect_same_in_steps<Chain>(rshock<double>(50'000), Law(1e-4), {2000, 3000},
                                                     {{{.steps = &all_steps().front()}, 2}});
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

void expect_same_in_a_wet_scene(Dice& dice) {
  double duration = 0;
  const Scene<double> scene = random_scene<double>(dice, dice.below(2) == 0, duration, false);
  const double loss = dice.one_of({0.3, 0.02, 1e-3, 1e-5}) * (0.1 + dice.uniform());
  expect_same_in_steps<Chain>(scene, Law(loss), std::vector<double>{0.6 * duration, duration}, random_ways(dice));
}
// The particle at the front becomes part of one that another segment owns.
TEST_F(WetSteps, MakeAFrontThatGoesOverACut) {
  Dice dice(1093727036);
  expect_same_in_a_wet_scene(dice);
}
TEST_F(WetSteps, RandomScenes) { expect_same_in_random_scenes(1, expect_same_in_a_wet_scene); }

}  // namespace cradle::test::wet_steps_test
