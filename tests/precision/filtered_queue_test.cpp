// The filtered queue: 64-bit keys made from rounded times, and exact times only if keys are too close. Proves that
// every collision of a run is the one that a search of all gaps finds, by the least (exact time, position), at that
// time to the last bit: in collapses, in shocks, in crowds and lattices, where many collisions are simultaneous, and
// under the wet law, where particles pass, merge and stream in. The number of index bits in a key changes no bit of a
// run; nor do segments, in these types, whose losses are summed up gap by gap, and with MPFR's working precision, one
// value per process set before the threads start. (A loop without a queue, from the start: random_scenes_test.cpp. Runs
// at once: tests/tools/ensemble/outputs.txt.)
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/tests/core/segmented.hpp"
#include "cradle/tests/core/slow_loop.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::filtered_queue_test {

using InDoubleToo = Joined<testing::Types<Precision<double>>, WidePrecision>::Types;  // where keys are exact times
PRECISION_SUITE(FilteredQueue, InDoubleToo);

template <class Chain, class Law, class T>
Simulation<T, Law, Chain> make(const Scene<T>& particles, const Law& law, int queue_bits = 3) {
  return {law, Chain(particles, T(0)), {}, queue_bits};
}

// Runs with several numbers of index bits in a key. Returns the close calls of the last.
template <class Chain, class Law, class T>
std::uint64_t expect_index_bits_change_no_bit(const Scene<T>& particles, const Law& law, const T& step, int steps) {
  auto run = make<Chain>(particles, law, 3), run13 = make<Chain>(particles, law, 13),
       run20 = make<Chain>(particles, law, 20);
  T t(0);
  for (int k = 0; k < steps; ++k) {
    t += step;
    for (auto* each : {&run, &run13, &run20}) EXPECT_EQ(each->advance(t), Status::reached);
    for (const auto* other : {&run13, &run20}) expect_same_state(run, *other, t);
  }
  return run20.counts().close_calls;
}

PRECISION_TEST(FilteredQueue, BouncingParticles) {
  const T zero(0), most = T(15) / T(16), cutoff = from_text<T>("1e-3");
  const struct {
    const char* name;
    Scene<T> particles;
    Inelastic<T> law;
    int end;
    std::uint64_t collisions, close_calls = 0;
  } rows[] = {
      {"mixed velocities", rmix<T>(32), Inelastic<T>(most, zero), 1000, 188},
      {"shock", rshock<T>(200), Inelastic<T>(from_text<T>(".9"), cutoff), 66, 5000},
      // Of a perfect lattice all pairs of a generation meet at one time, exactly representable.
      {"elastic lattice", lattice_rows<T>(40), Inelastic<T>(T(1), zero), 100, 20 * 21 / 2, 1},
      // Mirror symmetry makes pairs of equal times, and triple collisions that rounding decides.
      {"inelastic lattice", lattice_rows<T>(40), Inelastic<T>(most, cutoff), 30, 100, 1},
      // Times are small rationals at first, and many are equal.
      {"elastic crowds", crowds<T>(60, 5), Inelastic<T>(T(1), zero), 200, 181, 1},
      {"soft crowds", crowds<T>(60, 5), Inelastic<T>(T(3) / T(4), cutoff), 10, 100, 1},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    expect_each_the_first(make<GapChain<T>>(row.particles, row.law), T(row.end), row.collisions, row.close_calls);
  }
}

// From exactly simultaneous collisions to what a key resolves.
PRECISION_TEST(FilteredQueue, CrowdsWithAnyWidthOfTheIndex) {
  for (const int bits : {3, 16, 18})
    for (const char* restitution : {"1", "0.999999999999"})
      expect_each_the_first(make<GapChain<T>>(crowds<T>(300, 5), Inelastic<T>(from_text<T>(restitution)), bits), T(10),
                            901);
}

PRECISION_TEST(FilteredQueue, WetParticles) {
  const struct {
    Scene<T> particles;
    const char* loss;
    int end;
    std::uint64_t collisions, merges;
  } rows[] = {{rmix<T>(100), ".01", 300, 200, 60},
              {rshock<T>(200), ".01", 250, 2000, 150},
              {rshock<T>(2000), ".05", 500, 1000, 400},
              {unequal_rows<T>(), ".02", 100, 501, 51}};
  for (const auto& row : rows) {
    const Wet<T> law(from_text<T>(row.loss));
    EXPECT_GE(expect_each_the_first(make<ClusterChain<T>>(row.particles, law), T(row.end), row.collisions).merges,
              row.merges);
  }
}

PRECISION_TEST(FilteredQueue, Collapses) {
  const auto expect_many = [](const Scene<T>& particles, const char* restitution, int end, const char* gap) {
    expect_each_the_first(
        gap_run(particles, Inelastic<T>(from_text<T>(restitution), T(0)), stop_below(from_text<T>(gap))), T(end), 100);
  };
  for (const char* restitution : {".05", ".01", ".0625"}) expect_many(three_particles<T>(), restitution, 10, "1e-280");
  // At eps = 0.4 seven particles are enough: 2/(1 - (4/pi) atan sqrt eps) = 7.1.
  expect_many(rshock<T>(12), ".4", 100, "1e-200");
}

PRECISION_TEST(FilteredQueue, IndexBitsChangeNoBit) {
  using Chain = GapChain<T>;
  const T zero(0), most = T(15) / T(16);
  const Inelastic<T> law(from_text<T>(".9"), from_text<T>("1e-3"));
  expect_index_bits_change_no_bit<Chain>(rshock<T>(200), law, T(14), 5);
  expect_index_bits_change_no_bit<Chain>(rmix<T>(32), Inelastic<T>(most, zero), T(200), 5);
  for (const Scene<T>& particles : {rshock<T>(200), crowds<T>(60, 5)})
    expect_index_bits_change_no_bit<ClusterChain<T>>(particles, Wet<T>(from_text<T>(".01")), T(10), 6);
  // Where times are equal.
  EXPECT_GT(expect_index_bits_change_no_bit<Chain>(lattice_rows<T>(40), Inelastic<T>(most, zero), T(2), 8), 0U);
  EXPECT_GT(expect_index_bits_change_no_bit<Chain>(crowds<T>(60, 5), Inelastic<T>(T(1), zero), T(2), 20), 0U);
}

// ---- one run on several threads

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

}  // namespace cradle::test::filtered_queue_test
