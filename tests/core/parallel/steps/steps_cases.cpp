// Steps (core/parallel/steps). Proves: with steps, on each kind of vectors, runs in segments have the bits of the plain
// loop: every gap, closing speed, local time and lag, counts, losses and what walls gave, and every collision that is
// observed; for all laws that bounce, on lines, rows and rings, with equal and unequal masses, on lattices and through
// collapses. Nearly all collisions of gases are made in steps.
//
// The same program is built with errors planted in the vectors (CMakeLists.txt): it must fail with each of them.
#include "cradle/core/laws/one_of.hpp"
#include "cradle/tests/core/parallel/steps/ways.hpp"

namespace cradle::test::steps_test {

using Equal = GapChain<double>;
using Unequal = GapChain<double, IndividualMasses<double>>;
using Law = Inelastic<double>;
using Several = OneOf<Law, SpeedDependent<double>>;

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

class Steps : public WithSteps {};

TEST_F(Steps, RowsThatAreStreamed) { expect_same_by_all_laws<Equal>(rshock<double>(1400), {490, 495}, 0.5); }
TEST_F(Steps, ARowThatIsStreamedOnOneSide) {
  expect_same_by_all_laws<Unequal>(cold_gas(200, HotPlace::left), {2400, 2600}, 0.25);
}
TEST_F(Steps, GasOnALine) { expect_same_by_all_laws<Equal>(gas<double>(800), {1, 100}, 0.5); }
TEST_F(Steps, GasOnARing) { expect_same_by_all_laws<Equal>(gas<double>(700, 700.), {10, 50}, 0.5); }
TEST_F(Steps, UnequalMassesOnALine) { expect_same_by_all_laws<Unequal>(gas<double>(700, 0., true), {10, 100}, 0.5); }
TEST_F(Steps, UnequalMassesOnARing) { expect_same_by_all_laws<Unequal>(gas<double>(700, 700., true), {10, 60}, 0.5); }
// One segment goes around: collisions over the seam are made alone, and undone like the others.
template <class Chain> void expect_same_on_whole_rings(const Law& law, bool unequal) {
  const std::vector<SegmentsAs> ways = on_all_vectors({.anywhere = true}, 1);
  for (const ParticleIndex n : {520, 641, 900}) {
    SCOPED_TRACE(n);
    const SlabsMade made =
        expect_same_in_steps<Chain>(gas<double>(n, static_cast<double>(n), unequal), law, {10, 40}, ways);
    EXPECT_GT(static_cast<double>(made.in_steps), 0.9 * static_cast<double>(made.collisions));
    EXPECT_GT(made.collisions, 10'000U);
  }
}
TEST_F(Steps, RingsWithoutCuts) {
  expect_same_on_whole_rings<Equal>(Law(1), false);
  expect_same_on_whole_rings<Equal>(Law(0.999, 1e-5), false);
  expect_same_on_whole_rings<Unequal>(Law(0.9, 0.125), true);
}
// Dense and cold at both ends, or at rest there until impulses run through: what steps make out of order is found,
// undone and made again.
struct DenseAtEnds {
  std::vector<double> x, v;
  double end = 0;
  explicit DenseAtEnds(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (int i = 0; i < 800; ++i) {
      const bool dense = i < 40 || i >= 760;
      end += static_cast<double>(1 + (random() >> 40)) * (dense ? 0x1p-30 : 0x1p-23);
      x.push_back(end);
      v.push_back(static_cast<double>(random() >> 40) * (!dense ? 0x1p-23 : seed % 2 == 0 ? 0x1p-27 : 0));
    }
    end += 0x1p-30;
  }
};
TEST_F(Steps, ThatAreUndoneAtASeamAtWallsAndAtEnds) {
  const std::vector<SegmentsAs> ways = on_all_vectors({.anywhere = true}, 1),
                                halves = on_all_vectors({.gaps = 400, .anywhere = true}, 1);
  std::uint64_t on_rings = 0, at_walls = 0, at_ends = 0;
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    auto [x, v, end] = DenseAtEnds(seed);
    on_rings += expect_same_in_steps<Equal>(list(x, v, {}, end), Law(1), {5, 20}, ways).in_steps;
    const Wall<double> left{.position = 0}, right{.position = end, .temperature = 0.1, .seed = 5};
    const Scene<double> walled = std::make_shared<Walled<double>>(list(x, v), left, right);
    at_walls += expect_same_in_steps<Equal>(walled, Law(1), {5, 20}, ways).in_steps;
    std::vector<double> m(x.size(), 1);
    m.front() = m.back() = 1000;  // heavy outermost particles are met again and again
    v.front() = 1. / 64, v.back() = -1. / 64;
    at_ends += expect_same_in_steps<Unequal>(list(x, v, m), Law(1), {5, 20}, halves).in_steps;
  }
  EXPECT_GT(on_rings, 10'000U);
  EXPECT_GT(at_walls, 10'000U);
  EXPECT_GT(at_ends, 10'000U);
}
// Restitutions below and above 1/2, any exponents, and speeds over delta that are out of the range of vectors; also as
// one of several laws, as programs have it.
TEST_F(Steps, LawsThatAreVectors) {
  std::vector<SegmentsAs> ways = on_all_vectors({.anywhere = true}, 1);
  for (const SegmentsAs& as : on_all_vectors({.gaps = 150, .anywhere = true}, 2)) ways.push_back(as);
  std::uint64_t in_steps = 0;
  const auto check = [&](const auto& law) {
    in_steps += expect_same_in_steps<Unequal>(gas<double>(600, 600., true), law, {10, 30}, ways).in_steps;
    in_steps += expect_same_in_steps<Unequal>(gas<double>(600, 600., true), Several(law), {30}, ways).in_steps;
    in_steps += expect_same_in_steps<Equal>(gas<double>(600), law, {60}, ways).in_steps;
    in_steps += expect_same_in_steps<Equal>(gas<double>(600), Several(law), {60}, ways).in_steps;
  };
  for (const Law& law : {Law(1), Law(0.999, 1e-5), Law(0.3, 0.5)}) check(law);
  EXPECT_GT(std::exchange(in_steps, 0), 100'000U);
  for (const double exponent : {0.2, 1., 1.5, 3., 40., 250.5, 1e-4})
    for (const double restitution : {0.1, 0.3, 0.99}) {
      SCOPED_TRACE("exponent " + std::to_string(exponent) + ", restitution " + std::to_string(restitution));
      check(SpeedDependent<double>(restitution, 0.7, exponent));
    }
  for (const double delta : {1e-305, 1e305}) check(SpeedDependent<double>(0.99, delta, 0.5));
  EXPECT_GT(in_steps, 500'000U);
}
// Collisions are simultaneous all over the line: for the event loop.
TEST_F(Steps, LatticesFullOfTies) { expect_same_by_all_laws<Equal>(lattice_rows(900), {310}, 0); }
TEST_F(Steps, Walls) {
  expect_same_between_walls<Equal>({8, 60}, 0.5);
  expect_same_between_walls<Unequal>({40}, 0.5);
}
TEST_F(Steps, ColumnsAndShakenWalls) {
  expect_same_at_curved_walls<Equal>({100, 150}, 0.25);
  expect_same_at_curved_walls<Unequal>({130}, 0.25);
}

// ---- the vectors alone, on a line whose ends fly apart, against the plainest loop

struct NoEdges final : StepScalars {
  int undone = 0;
  bool collide(std::size_t) override { return false; }
  void outcomes(const std::uint32_t*, std::size_t) override {}
  void keep() override {}
  void restore() override { ++undone; }
};

struct Gas {
  std::vector<Gap<double>> gaps;
  std::vector<double> lags;
};

// The middle is `dense` times as dense, and cold: a fast particle sends its impulse far through it.
Gas random_gas(std::size_t gaps, double dense, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> speed;
  Gas gas{std::vector<Gap<double>>(gaps), std::vector<double>(gaps)};
  double before = speed(random);
  for (std::size_t i = 0; i < gaps; ++i) {
    const bool middle = i / 100 == 2;
    const double next = speed(random) / (middle ? dense / 10 : 1), w = i == 0 || i + 1 == gaps ? -1e6 : before - next;
    Gap<double>& gap = gas.gaps[i];
    gap.gap = (0.5 + static_cast<double>(random() >> 11) * 0x1p-53) / (middle ? dense : 1);
    gap.closing = w;
    gap.due = w > 0 ? gap.gap / w : StepLine::never;
    before = next;
  }
  return gas;
}

StepTask elastic_until(double stop) {
  StepTask task;
  task.law = StepLaw::hard;
  task.floor = 1e-300, task.rounder = 3e6, task.per_fine = 1;
  task.stop = stop, task.most = 1'000'000'000;
  return task;
}

// Elastic collisions in the order of their times.
std::uint64_t plain_loop(std::vector<Gap<double>>& gaps, double stop) {
  for (std::uint64_t made = 0;; ++made) {
    const auto next = std::ranges::min_element(gaps, {}, &Gap<double>::due);
    const double time = next->due, w = next->closing;
    if (!(time <= stop)) return made;
    for (const auto beside : {next - 1, next + 1}) {
      beside->gap -= beside->closing * (time - beside->time);
      beside->time = time;
      beside->closing += w;
      beside->due = beside->closing > 0 ? time + beside->gap / beside->closing : StepLine::never;
    }
    next->gap = 0, next->closing = -w, next->time = time, next->due = StepLine::never;
  }
}

// Where impulses run far some of what steps make is out of order: that is found and made again. In a gas hardly ever.
TEST_F(Steps, AreCheckedAndHardlyEverUndone) {
  constexpr std::size_t gaps = 500;
  constexpr double stop = 6;
  int undone_in_gas = 0, undone_in_core = 0, done = 0;
  for (const cradle::Steps& steps : all_steps())
    for (const double dense : {1., 300.})
      for (std::uint64_t seed = 1; seed < 20; ++seed) {
        SCOPED_TRACE(std::string(steps.target) + ", seed " + std::to_string(seed));
        Gas plain = random_gas(gaps, dense, seed), gas = plain;
        StepLine line;
        line.take(gas.gaps.data(), gas.lags.data(), gaps);
        line.inner_first = 1, line.inner_count = static_cast<std::uint32_t>(gaps - 2);
        NoEdges scalars;
        StepResult result;
        StepPace pace{.length = 0.003};
        if (!steps.run(line, elastic_until(stop), scalars, pace, result)) {
          ASSERT_GT(dense, 1) << "a gas is for steps";
          continue;  // too few collisions in a step to pay
        }
        ++done;
        EXPECT_EQ(result.collisions, plain_loop(plain.gaps, stop));
        for (std::size_t i = 0; i < gaps; ++i) {
          ASSERT_EQ(bits(gas.gaps[i].gap), bits(plain.gaps[i].gap)) << i;
          ASSERT_EQ(bits(gas.gaps[i].closing), bits(plain.gaps[i].closing)) << i;
          ASSERT_EQ(bits(gas.gaps[i].time), bits(plain.gaps[i].time)) << i;
          ASSERT_EQ(bits(gas.gaps[i].due), bits(plain.gaps[i].due)) << i;
        }
        (dense > 1 ? undone_in_core : undone_in_gas) += scalars.undone;
      }
  EXPECT_GT(done, 30 * static_cast<int>(all_steps().size()));
  EXPECT_LE(undone_in_gas, 4);
  EXPECT_GT(undone_in_core, 0) << "steps that fail are part of what is to be shown";
}

// What collisions of a tile's gaps set off in fewer passes than a tile has gaps can be undone, over the seam of a ring
// too.
TEST_F(Steps, AnUndoCopyReachesAsFarAsImpulses) {
  for (const bool ring : {false, true})
    for (const std::size_t gaps : {100U, 112U, 113U, 127U}) {
      const Gas before = random_gas(gaps, 1, 3);
      Gas now = before;
      StepLine line;
      line.take(now.gaps.data(), now.lags.data(), gaps);
      line.ring = ring;
      for (std::size_t tile = 0; tile < line.tiles(); ++tile) {
        SCOPED_TRACE((ring ? "ring of " : "line of ") + std::to_string(gaps) + ", tile " + std::to_string(tile));
        line.keep();
        line.guard(tile);
        const std::size_t first = StepLine::tile * tile, last = std::min(first + StepLine::tile, gaps) - 1;
        std::size_t left = first, right = last;
        for (std::size_t reach = 1; reach < StepLine::tile; ++reach) {
          left = line.left_of(left), right = std::min(line.right_of(right), gaps - 1);
          for (const std::size_t i : {left, right}) now.gaps[i].gap = -1, line.due[i] = 0;
        }
        for (std::size_t i = first; i <= last; ++i) now.gaps[i].time = 7;
        line.restore();
        for (std::size_t i = 0; i < gaps; ++i) {
          ASSERT_EQ(now.gaps[i].gap, before.gaps[i].gap) << i;
          ASSERT_EQ(now.gaps[i].time, before.gaps[i].time) << i;
          ASSERT_EQ(line.due[i], before.gaps[i].due) << i;
        }
      }
    }
}

// Of segments as they are chosen, nearly all collisions are made in steps, and cuts hold.
TEST_F(Steps, MakeNearlyAllCollisionsOfAGas) {
  for (const SegmentsAs& as : on_all_vectors({.gaps = 700, .anywhere = true}, 2)) {
    const SlabsMade made = expect_same_in_steps<Equal>(gas<double>(3000), Law(0.999, 1e-5), {60}, {as});
    EXPECT_GT(made.slabs, 4U);
    EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions)) << as.how.steps->target;
  }
}

TEST_F(Steps, SlowFigure2IntoItsCollapse) {
  const SlabsMade made = expect_same_in_steps<Equal>(rshock<double>(8000), Inelastic<double>(0.999, 1e-5), {6000, 6500},
                                                     {{{.steps = &all_steps().front()}, 2}});
  EXPECT_GT(static_cast<double>(made.in_steps), 0.95 * static_cast<double>(made.collisions));
}

TEST_F(Steps, RandomScenes) { expect_same_in_random_scenes<Equal, Unequal>(1); }

}  // namespace cradle::test::steps_test
