// The filtered queue under the wet law: 64-bit keys made from rounded times, exact times only where keys are too close
// to call. Proves it equal to a loop that looks through all gaps for the least (exact time, position): every particle
// has the same collisions with the same others in the same order, at the same times to the last bit, where particles
// pass, merge and stream in. The number of index bits in a key changes no bit of a run.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/precision/search.hpp"

namespace wet_filtered_queue_test {

using namespace cradle;
using namespace cradle::test;

template <class P> using WetFilteredQueue = InPrecision<P>;
TYPED_TEST_SUITE(WetFilteredQueue, WidePrecision, PrecisionName);

template <class T> using WetRun = Simulation<T, Wet<T>, ClusterChain<T>>;
template <class T> WetRun<T> wet_run(const Scene<T>& particles, const T& loss, int least_queue_bits = 3) {
  return {Wet<T>(loss), ClusterChain<T>(particles, T(0)), Policy<T>{}, least_queue_bits};
}

template <class T>
void expect_same_collisions(const Scene<T>& particles, const T& loss, const T& end, std::uint64_t least_collisions,
                            std::uint64_t least_merges) {
  const Recorded<T> run = recorded(wet_run(particles, loss), end);
  EXPECT_GE(run.counts.collisions, least_collisions);
  EXPECT_GE(run.counts.merges, least_merges);
  expect_same_meetings(run.meetings, searched(ClusterChain<T>(particles, T(0)), Wet<T>(loss), run));
}

TYPED_TEST(WetFilteredQueue, MixedVelocities) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rmix<T>(100), from_text<T>(".01"), T(300), 200, 60);
}

TYPED_TEST(WetFilteredQueue, Shock) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rshock<T>(200), from_text<T>(".01"), T(250), 2000, 150);
}

TYPED_TEST(WetFilteredQueue, SlowShock) {
  using T = typename TypeParam::Scalar;
  expect_same_collisions(rshock<T>(2000), from_text<T>(".05"), T(500), 1000, 400);
}

TYPED_TEST(WetFilteredQueue, IndexBitsChangeNoBit) {
  using T = typename TypeParam::Scalar;
  for (const Scene<T>& particles : {rshock<T>(200), integers<T>()})
    expect_index_bits_change_no_bit([&](int bits) { return wet_run(particles, from_text<T>(".01"), bits); }, T(10), 6);
}

}  // namespace wet_filtered_queue_test
