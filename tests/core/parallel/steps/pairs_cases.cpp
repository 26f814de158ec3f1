// Steps in double-double (core/parallel/steps/pairs.inl). Proves: runs in segments with steps have the bits of the
// plain loop: both doubles of every gap, closing speed, local time, lag and loss; on lines, rows and rings, with equal
// and unequal masses, between walls, on lattices, on 1, 2, 3 and 8 threads. Nearly
// all collisions of gases are made in steps.
//
// As steps_cases.cpp it is built with errors planted too, and must fail with each of them.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "cradle/core/initial/walled.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/precision/double_double.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace steps_of_pairs_test {

using namespace cradle;
using namespace cradle::test;

using T = double_double;
using Equal = GapChain<T>;
using Unequal = GapChain<T, IndividualMasses<T>>;

T part(int numerator, int denominator) { return T(numerator) / T(denominator); }

struct Made {
  std::uint64_t collisions = 0, in_steps = 0, slabs = 0;
};

// One run in the plain loop, and one for each way to go in segments, through the same times.
template <class Chain>
Made expect_same(const Scene<T>& scene, const Inelastic<T>& law, const std::vector<int>& times,
                 const std::vector<SegmentsAs>& ways) {
  using Run = Simulation<T, Inelastic<T>, Chain>;
  Made made;
  std::vector<Run> segmented;
  std::vector<Segments<Inelastic<T>, Chain>> segments;
  for (const SegmentsAs& as : ways) {
    segmented.emplace_back(law, Chain(scene, T(0)));
    segments.emplace_back(threads(as.threads), as.how);
  }
  Run plain(law, Chain(scene, T(0)));
  for (const int time : times) {
    const Status status = plain.advance(T(time));
    for (std::size_t k = 0; k < ways.size(); ++k) {
      SCOPED_TRACE(std::to_string(ways[k].how.gaps) + " gaps, " + std::to_string(ways[k].how.ghosts) + " ghosts, " +
                   std::to_string(ways[k].threads) + " threads, until " + std::to_string(time));
      EXPECT_EQ(segmented[k].advance(T(time), segments[k]), status);
      expect_same_state(plain, segmented[k], T(time));
      expect_same_bits(plain.chain(), segmented[k].chain());
      if (::testing::Test::HasFailure()) return made;
    }
    if (status != Status::reached) break;
  }
  for (const auto& one : segments) {
    made.collisions += one.statistics().collisions;
    made.in_steps += one.statistics().in_steps;
    made.slabs += one.statistics().slabs;
  }
  return made;
}

class StepsOfPairs : public ::testing::Test {
  void SetUp() override {
    if (fastest_steps() == nullptr) GTEST_SKIP() << "no vectors of four lanes";
  }
};

// On all vectors that are wide enough, the others left to the event loop.
std::vector<SegmentsAs> all_ways() {
  std::vector<SegmentsAs> ways = segmentations();
  for (std::size_t k = 0; k < ways.size(); ++k) ways[k].how.steps = &all_steps()[k % all_steps().size()];
  for (SegmentsAs as : segmentations()) {
    as.how.steps = fastest_steps();
    ways.push_back(as);
  }
  return ways;
}

template <class Chain>
void expect_same_by_all_laws(const Scene<T>& scene, const std::vector<int>& times, bool in_steps) {
  Made all;
  const auto check = [&](const char* name, const T& restitution, const T& cutoff) {
    SCOPED_TRACE(name);
    const Made made = expect_same<Chain>(scene, Inelastic<T>(restitution, cutoff), times, all_ways());
    all.collisions += made.collisions, all.in_steps += made.in_steps, all.slabs += made.slabs;
  };
  check("elastic", T(1), T(0));
  check("nearly elastic", part(999, 1000), part(1, 100'000));
  check("with a cut-off", part(9, 10), part(1, 8));
  check("soft", part(3, 10), part(1, 2));
  EXPECT_GT(all.slabs, 100U);
  EXPECT_GE(all.in_steps, in_steps ? all.collisions / 4 : 0);
}

TEST_F(StepsOfPairs, RowsThatAreStreamed) { expect_same_by_all_laws<Equal>(rshock<T>(1200), {420, 424}, true); }
TEST_F(StepsOfPairs, GasOnALine) { expect_same_by_all_laws<Equal>(gas<T>(800), {1, 60}, true); }
TEST_F(StepsOfPairs, GasOnARing) { expect_same_by_all_laws<Equal>(gas<T>(700, T(700)), {10, 40}, true); }
TEST_F(StepsOfPairs, UnequalMassesOnALine) {
  expect_same_by_all_laws<Unequal>(gas<T>(700, T(0), true), {10, 60}, true);
}
TEST_F(StepsOfPairs, UnequalMassesOnARing) {
  expect_same_by_all_laws<Unequal>(gas<T>(700, T(700), true), {10, 40}, true);
}
// Collisions are simultaneous all over the line: for the event loop.
TEST_F(StepsOfPairs, LatticesFullOfTies) { expect_same_by_all_laws<Equal>(lattice_rows<T>(900), {310}, false); }
TEST_F(StepsOfPairs, Walls) {
  const Wall<T> hot{.position = T(-1), .temperature = 0.4, .seed = 5, .replica = 2};
  const Wall<T> moving{.position = T(-1), .speed = part(1, 10), .restitution = part(9, 10)};
  const Wall<T> cool{.position = T(801), .temperature = 0.1, .seed = 5, .replica = 2};
  const auto between = [](const Scene<T>& scene, const Wall<T>& left, const Wall<T>& right) {
    return std::make_shared<Walled<T>>(scene, left, right);
  };
  expect_same_by_all_laws<Equal>(between(gas<T>(800), hot, cool), {8, 40}, true);
  expect_same_by_all_laws<Unequal>(between(gas<T>(800, T(0), true), moving, cool), {40}, true);
}

TEST_F(StepsOfPairs, MakeNearlyAllCollisionsOfAGas) {
  const Made made = expect_same<Equal>(gas<T>(3000), Inelastic<T>(part(999, 1000), part(1, 100'000)), {20, 40, 60, 80},
                                       {{{.gaps = 700, .anywhere = true, .steps = fastest_steps()}, 2}});
  EXPECT_GT(made.slabs, 4U);
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

TEST_F(StepsOfPairs, LeaveNothingOutThatIsObserved) {
  for (const SegmentsAs& as : all_ways())
    expect_same_in_segments<Equal>(gas<T>(800), Inelastic<T>(part(999, 1000), part(1, 100'000)), as,
                                   std::vector{T(1), T(20)});
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
  const Scene<T> scene = std::make_shared<List<T>>(std::move(x), std::move(v));
  const Made made = expect_same<Equal>(scene, Inelastic<T>(T(1)), {1, 2, 5, 20}, all_ways());
  EXPECT_GT(made.in_steps, 1000U);
}

TEST_F(StepsOfPairs, SlowFigure2) {
  const Made made = expect_same<Equal>(rshock<T>(8000), Inelastic<T>(part(999, 1000), part(1, 100'000)), {4000},
                                       {{{.steps = fastest_steps()}, 2}});
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

// Scenes and segmentations drawn at random.
TEST_F(StepsOfPairs, RandomGases) {
  for (std::uint64_t seed = 1; seed < 40 && !HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t n) { return random() % n; };
    const auto n = static_cast<ParticleIndex>(20 + 2 * below(300));
    const bool unequal = below(2) == 0;
    const Scene<T> scene = gas<T>(n, below(3) == 0 ? T(n) : T(0), unequal);
    std::vector<SegmentsAs> ways;
    for (const Steps& steps : all_steps())
      ways.push_back({{.gaps = 1 + below(400), .ghosts = 1 + below(80), .anywhere = true, .steps = &steps},
                      static_cast<unsigned>(1 + below(3))});
    const Inelastic<T> law(part(static_cast<int>(400 + below(601)), 1000), part(1, static_cast<int>(10 + below(90))));
    const int time = static_cast<int>(1 + below(30));
    unequal ? expect_same<Unequal>(scene, law, {time, 2 * time}, ways)
            : expect_same<Equal>(scene, law, {time, 2 * time}, ways);
  }
}

}  // namespace steps_of_pairs_test
