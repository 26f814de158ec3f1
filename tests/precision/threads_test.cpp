// Threads in the types whose queue keys are rounded times: double-double, binary128 and MPFR, whose working precision
// is one value per process set before the threads start. Proves: one run in segments has the bits of the plain loop
// there too, the energy lost included, which these types sum up gap by gap. (Runs at once:
// tools/ensemble/same_bytes_test.cpp.)
#include "cradle/tests/core/segmented.hpp"

#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::precision_threads_test {

PRECISION_SUITE(WideThreads, WidePrecision);

template <class T, class Masses> void expect_same_gaps(const Scene<T>& scene, const std::vector<T>& times) {
  SlabsMade all;
  for (const Inelastic<T>& law :
       {Inelastic<T>(T(999) / T(1000), T(1) / T(100000)), Inelastic<T>(T(3) / T(10), T(1) / T(2))})
    for (const SegmentsAs& as : {SegmentsAs{{.gaps = 40, .ghosts = 4, .collisions = 4, .anywhere = true}, 2},
                                 SegmentsAs{{.gaps = 150, .ghosts = 48, .anywhere = true}, 3}})
      all += expect_same_in_segments<GapChain<T, Masses>>(scene, law, {as}, times);
  EXPECT_GT(all.slabs, 10U);
  EXPECT_GT(all.again, 0U);
}

PRECISION_TEST(WideThreads, SegmentsOfRowsThatAreStreamedOfGasesOnARingAndOnALine) {
  expect_same_gaps<T, IdenticalMasses<T>>(rshock<T>(1200), {T(500), T(520)});
  expect_same_gaps<T, IdenticalMasses<T>>(gas<T>(600, T(600)), {T(5), T(25)});
  expect_same_gaps<T, IndividualMasses<T>>(gas<T>(700, T(0), true), {T(10), T(80)});
}

// Wet and sticky: particles merge, and with them what their gaps have lost.
PRECISION_TEST(WideThreads, SegmentsOfParticlesThatMergeOnARing) {
  const SegmentsAs as{{.gaps = 40, .ghosts = 8, .collisions = 4, .anywhere = true}, 2};
  const Scene<T> scene = gas<T>(600, T(600), true);
  SlabsMade made = expect_same_in_segments<ClusterChain<T>>(scene, Wet<T>(T(1) / T(50)), {as}, {T(5), T(40)});
  made += expect_same_in_segments<ClusterChain<T>>(scene, Sticky<T>(), {as}, {T(5), T(40)});
  EXPECT_GT(made.slabs, 10U);
  EXPECT_GT(made.again, 0U);
}

}  // namespace cradle::test::precision_threads_test
