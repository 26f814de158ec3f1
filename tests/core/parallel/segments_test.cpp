// One run in segments. Proves: for all cuts, ghosts, time slabs and threads, a run has the bits of the plain loop at
// every time at which it stops, and an observer receives the same collisions in the same order; with laws, masses,
// lines, rows and rings, gravity and shaken walls, simultaneous collisions, collapsed cores and time slabs that fail at
// every cut.
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test::segments_test {

template <class Chain, class T, class Law>
SlabsMade in_all_segmentations(const Scene<T>& scene, const Law& law, const std::vector<int>& times) {
  return expect_same_in_segments<Chain>(scene, law, segmentations(), std::vector<T>(times.begin(), times.end()));
}

template <template <class> class Masses, class T>
void expect_same(const std::vector<Scene<T>>& scenes, const std::vector<int>& times) {
  SlabsMade all;
  for (const Scene<T>& scene : scenes)
    for (const Inelastic<T>& law : laws<T>()) {
      SCOPED_TRACE("eps = " + std::to_string(to_double(law.restitution())));
      all += in_all_segmentations<GapChain<T, Masses<T>>>(scene, law, times);
    }
  EXPECT_GT(all.slabs, 400U);
  EXPECT_GT(all.again, 5000U) << "cuts that fail are part of what is to be shown";
}
template <template <class> class Masses, class T>
void expect_same(const Scene<T>& scene, const std::vector<int>& times) {
  expect_same<Masses>(std::vector<Scene<T>>{scene}, times);
}

// Particles that merge, by a list of laws.
template <class T, class... Laws>
void expect_same_clusters(const Scene<T>& scene, const std::vector<int>& times, const Laws&... law) {
  SlabsMade all;
  const auto by = [&](const auto& one) {
    const SlabsMade made = in_all_segmentations<ClusterChain<T>>(scene, one, times);
    EXPECT_GT(made.slabs, 20U);
    all += made;
  };
  (by(law), ...);
  EXPECT_GT(all.again, 10'000U) << "cuts that fail are part of what is to be shown";
}
template <class T> void expect_same_merging(const Scene<T>& scene, const std::vector<int>& times) {
  expect_same_clusters(scene, times, Wet<T>(T(1) / T(50)), Wet<T>(T(1) / T(5000)), Sticky<T>(),
                       InelasticMerging<T>(Inelastic<T>(T(9) / T(10)), T(1) / T(20)));
}

// ---- law x initial state x masses x type x segmentation, with and without an observer, at several times

template <class T> class Cells : public ::testing::Test {
 protected:
  static Scene<T> line(bool unequal = false) { return gas<T>(unequal ? 700 : 800, T(0), unequal); }
  static Scene<T> ring(bool unequal = false) { return gas<T>(700, T(700), unequal); }
};
using Types = ::testing::Types<double, long double, float>;
TYPED_TEST_SUITE(Cells, Types);

TYPED_TEST(Cells, RowsThatAreStreamed) { expect_same<IdenticalMasses>(rshock<TypeParam>(1400), {0, 520, 521, 560}); }
TYPED_TEST(Cells, GasOnALine) { expect_same<IdenticalMasses>(this->line(), {1, 100, 160}); }
TYPED_TEST(Cells, GasOnARing) { expect_same<IdenticalMasses>(this->ring(), {10, 50}); }
TYPED_TEST(Cells, UnequalMassesOnALine) { expect_same<IndividualMasses>(this->line(true), {10, 100}); }
TYPED_TEST(Cells, UnequalMassesOnARing) { expect_same<IndividualMasses>(this->ring(true), {10, 60}); }
TYPED_TEST(Cells, ParticlesThatMergeOnARing) { expect_same_merging(this->ring(), {2, 10, 60}); }
TYPED_TEST(Cells, UnequalParticlesThatMergeOnARing) { expect_same_merging(this->ring(true), {2, 10, 60}); }
TYPED_TEST(Cells, ParticlesThatMergeOnALine) { expect_same_merging(this->line(), {1, 100, 160}); }
TYPED_TEST(Cells, UnequalParticlesThatMergeOnALine) { expect_same_merging(this->line(true), {1, 100}); }
TYPED_TEST(Cells, RowsThatMergeAsTheyAreStreamed) {
  using T = TypeParam;
  expect_same_clusters(rshock<T>(1400), {500, 520, 560, 700}, Wet<T>(T(1) / T(5000)), Wet<T>(T(1) / T(50000)));
}
// Cuts beside walls and far from them, and walls among the ghosts.
TYPED_TEST(Cells, ColumnsAndShakenWalls) {
  expect_same<IdenticalMasses>(lines_at_curved_walls<TypeParam>(600), {90, 170});
}
TYPED_TEST(Cells, UnequalMassesInColumns) {
  expect_same<IndividualMasses>(lines_at_curved_walls<TypeParam>(600, true), {90, 170});
}
// Collisions are simultaneous all over the line; the time slabs that hold such are for the plain loop, or for exact
// times.
TYPED_TEST(Cells, LatticesFullOfTies) { expect_same<IdenticalMasses>(lattice_rows<TypeParam>(1200), {520, 550, 551}); }
// Pairs on three quarters of a ring, whose collisions are all at the same time; the seam is where there are none.
TYPED_TEST(Cells, MergersAtTheSameTime) {
  using T = TypeParam;
  const Scene<T> like = rmix<T>(800);
  std::vector<T> x, v;
  for (int i = 0; i < 800; ++i) {
    const bool pairs = i >= 100 && i < 700;
    x.push_back(pairs ? T(i) : like->position(i));
    v.push_back(pairs ? T(i % 2 == 0 ? 1 : -1) : like->velocity(i));
  }
  const auto scene = list<T>(std::move(x), std::move(v), {}, T(800));
  SlabsMade made = in_all_segmentations<ClusterChain<T>>(scene, Wet<T>(T(1) / T(8)), {1, 2, 9});
  made += in_all_segmentations<ClusterChain<T>>(scene, Sticky<T>(), {1, 2, 9});
  EXPECT_GT(made.slabs, 10U);
  EXPECT_GT(made.again, 100U);
}

// ---- hot walls and walls that move, and masses that repeat where particles come in

using Gaps = GapChain<double>;
using Masses = GapChain<double, IndividualMasses<double>>;

TEST(Segments, BetweenWalls) {
  const Inelastic<double> law(0.98, 1e-3), soft(0.98, 0.1);
  SlabsMade made = in_all_segmentations<Gaps>(gas_between_walls<double>(), law, {8, 9, 40});
  made += in_all_segmentations<Masses>(gas_between_walls<double>(true), law, {9});
  made += in_all_segmentations<Gaps>(between(0, uniform_rows(1600), Wall<double>{-805., .8}), soft, {350});
  EXPECT_GT(made.slabs, 200U);
}
TEST(Segments, OfMassesThatRepeat) {
  const Inelastic<double> law(0.999, 1e-5), elastic(1.);
  SlabsMade made = in_all_segmentations<Masses>(unequal_rows<double>({}, three_masses, 3), law, {500, 520});
  made += in_all_segmentations<Masses>(cold_gas(32, HotPlace::middle), elastic, {1200, 1300});
  EXPECT_GT(made.slabs, 20U);
}

// ---- the paper's shock through its collapse: every collision beyond t = 6500 in a core of a few dozen particles

TEST(SlowSegments, Figure2ThroughItsCollapse) {
  const Inelastic<double> law(0.999, 1e-5);
  const auto made = expect_same_in_segments<Gaps>(rshock<double>(8000), law, {{{.gaps = 1500, .ghosts = 48}, 2, false}},
                                                  std::vector{6000., 6500., 6550.});
  EXPECT_GT(made.slabs, 1000U);
}

}  // namespace cradle::test::segments_test
