// One run in segments. Proves: for all cuts, ghosts, time slabs and threads, a run has the bits of the plain loop at
// every time at which it stops, and an observer receives the same collisions in the same order; with laws, masses,
// lines, rows and rings, simultaneous collisions, collapsed cores and time slabs that fail at every cut.
#include <gtest/gtest.h>

#include "cradle/tests/core/segmented.hpp"

namespace segments_test {

using namespace cradle;
using namespace cradle::test;

template <class T> std::vector<Inelastic<T>> laws() {
  const auto law = [](int restitution, int cutoff) {
    return Inelastic<T>(T(restitution) / T(1000), cutoff > 0 ? T(1) / T(cutoff) : T(0));
  };
  return {law(1000, 0), law(999, 100000), law(900, 8), law(300, 2)};
}

template <class Chain, class T, class Law>
SlabsMade expect_same_by(const Law& law, const Scene<T>& scene, const std::vector<T>& times) {
  SlabsMade made;
  for (const SegmentsAs& as : segmentations()) {
    SCOPED_TRACE(std::to_string(as.how.gaps) + " gaps, " + std::to_string(as.how.ghosts) + " ghosts, " +
                 std::to_string(as.threads) + " threads");
    made += expect_same_in_segments<Chain>(scene, law, as, times);
  }
  return made;
}

template <class T, class Masses> void expect_same(const Scene<T>& scene, const std::vector<T>& times) {
  SlabsMade all;
  for (const Inelastic<T>& law : laws<T>()) {
    SCOPED_TRACE("eps = " + std::to_string(to_double(law.restitution())));
    all += expect_same_by<GapChain<T, Masses>>(law, scene, times);
  }
  EXPECT_GT(all.slabs, 400U);
  EXPECT_GT(all.again, 5000U) << "cuts that fail are part of what is to be shown";
}

template <class T> void expect_same_clusters(const Scene<T>& scene, const std::vector<T>& times) {
  const auto all = [&](const char* name, const auto& law) {
    SCOPED_TRACE(name);
    const SlabsMade made = expect_same_by<ClusterChain<T>>(law, scene, times);
    EXPECT_GT(made.slabs, 20U);
    EXPECT_GT(made.again, 500U) << "cuts that fail are part of what is to be shown";
  };
  all("wet", Wet<T>(T(1) / T(50)));
  all("hardly wet", Wet<T>(T(1) / T(5000)));
  all("sticky", Sticky<T>());
  all("sticky when slow", InelasticMerging<T>(Inelastic<T>(T(9) / T(10)), T(1) / T(20)));
}

// ---- law x initial state x masses x type x segmentation: 510 runs, every one compared at several times

template <class T> class Cells : public ::testing::Test {};
using Types = ::testing::Types<double, long double, float>;
TYPED_TEST_SUITE(Cells, Types);

TYPED_TEST(Cells, RowsThatAreStreamed) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(rshock<T>(1400), {T(0), T(520), T(521), T(560)});
}
TYPED_TEST(Cells, GasOnALine) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(gas<T>(800), {T(1), T(100), T(160)});
}
TYPED_TEST(Cells, GasOnARing) {
  using T = TypeParam;
  expect_same<T, IdenticalMasses<T>>(gas<T>(700, T(700)), {T(10), T(50)});
}
TYPED_TEST(Cells, UnequalMassesOnALine) {
  using T = TypeParam;
  expect_same<T, IndividualMasses<T>>(gas<T>(700, T(0), true), {T(10), T(100)});
}
TYPED_TEST(Cells, UnequalMassesOnARing) {
  using T = TypeParam;
  expect_same<T, IndividualMasses<T>>(gas<T>(700, T(700), true), {T(10), T(60)});
}
TYPED_TEST(Cells, ParticlesThatMergeOnARing) {
  using T = TypeParam;
  expect_same_clusters<T>(gas<T>(700, T(700)), {T(2), T(10), T(60)});
}
TYPED_TEST(Cells, UnequalParticlesThatMergeOnARing) {
  using T = TypeParam;
  expect_same_clusters<T>(gas<T>(700, T(700), true), {T(2), T(10), T(60)});
}
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
  const Scene<T> scene = std::make_shared<List<T>>(std::move(x), std::move(v), std::vector<T>(), T(800));
  SlabsMade made = expect_same_by<ClusterChain<T>>(Wet<T>(T(1) / T(8)), scene, {T(1), T(2), T(9)});
  made += expect_same_by<ClusterChain<T>>(Sticky<T>(), scene, {T(1), T(2), T(9)});
  EXPECT_GT(made.slabs, 10U);
  EXPECT_GT(made.again, 100U);
}
// Collisions are simultaneous all over the line; the time slabs that hold such are for the plain loop, or for exact
// times.
TYPED_TEST(Cells, LatticesFullOfTies) {
  using T = TypeParam;
  const auto nowhere = [](ParticleIndex) { return std::int64_t{0}; };
  expect_same<T, IdenticalMasses<T>>(std::make_shared<Rows<T>>(symmetric_rows<T>(1200, T(1) / T(2), T(1), nowhere)),
                                     {T(520), T(550), T(551)});
}

// ---- the paper's shock through its collapse: every collision beyond t = 6500 in a core of a few dozen particles

TEST(SlowSegments, Figure2ThroughItsCollapse) {
  const Inelastic<double> law(0.999, 1e-5);
  const auto made = expect_same_in_segments<GapChain<double>>(
      rshock<double>(8000), law, {{.gaps = 1500, .ghosts = 48}, 2, false}, std::vector{6000., 6500., 6550.});
  EXPECT_GT(made.slabs, 1000U);
}

}  // namespace segments_test
