// Histograms. Proves: every number is in the bin that holds it; what collisions give is what a list of them gives, in
// the plain loop, in segments, streamed, and from a saved state; clusters counted by hand.
#include "cradle/core/observe/histograms.hpp"

#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test::histograms_test {

TEST(OctaveBins, HoldTheirNumbers) {
  for (const OctaveBins& bins : {OctaveBins::of_numbers(1e-3, 50), OctaveBins::of_numbers(1e-300, 1e300),
                                 OctaveBins::of_counts(), OctaveBins::of_numbers(1, 1)}) {
    const std::vector<double> low = bins.low();
    ASSERT_EQ(low.size(), bins.size());
    EXPECT_TRUE(std::is_sorted(low.begin(), low.end()));
    EXPECT_EQ(low.front(), 0);
    for (std::size_t k = 0; k < low.size(); ++k) {
      EXPECT_EQ(bins(low[k]), k);
      if (k > 0) {
        EXPECT_EQ(bins(std::nextafter(low[k], 0.)), k - 1);
      }
      if (k > 8 && k + 1 < low.size()) {  // an eighth of an octave
        EXPECT_LE(low[k + 1], 1.125 * low[k]);
      }
    }
    EXPECT_EQ(bins(std::numeric_limits<double>::infinity()), low.size() - 1);
  }
  const OctaveBins bins = OctaveBins::of_numbers(1e-3, 50);
  for (const double x : {0., -0., -1., 1e-320}) EXPECT_EQ(bins(x), 0U);
  EXPECT_LE(bins.low()[1], 1e-3);
  EXPECT_GT(bins.low().back(), 50);
  const std::vector<double> counts = OctaveBins::of_counts().low();
  for (std::size_t k = 0; k <= 16; ++k) EXPECT_EQ(counts[k], static_cast<double>(k));
}

using Histogram = CollisionHistograms<double>;
using Counts = std::vector<std::uint64_t>;
const OctaveBins bins = OctaveBins::of_numbers(1e-6, 1e3);

std::vector<Counts> all_counts(const Histogram& h) {
  return {h.free_flights.counts(), h.pair_flights.counts(), h.closing_speeds.counts(), h.dissipative_speeds.counts(),
          h.collisions_per_particle().counts()};
}
template <class Run> auto into(Histogram& histogram, const Run& run) {
  return [&](const Collision<double>& c) { histogram.made(run.counts()), histogram(c); };
}

// The plainest way: a list of all collisions, and what lies between them.
struct Listed {
  double time, speed;
  ParticleIndex left, right;
  std::uint64_t below_before;
};
template <class Run>
std::vector<Counts> counted(const std::vector<Listed>& all, const Run& run, ParticleIndex n, double from, double to) {
  OctaveHistogram free(bins), pair(bins), speeds(bins), dissipative(bins), per_particle(OctaveBins::of_counts());
  std::map<ParticleIndex, double> last, last_pair;
  std::map<ParticleIndex, std::uint64_t> collisions;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Listed& c = all[k];
    const bool inside = c.time >= from && c.time <= to, wall = c.left < 0 || c.right >= n;
    for (const ParticleIndex p : {c.left, c.right}) {
      if (p < 0 || p >= n) continue;
      if (inside && last.contains(p)) free.add(c.time - last[p]);
      last[p] = c.time;
      collisions[p] += inside;
    }
    if (wall) continue;
    if (inside && last_pair.contains(c.left)) pair.add(c.time - last_pair[c.left]);
    last_pair[c.left] = c.time;
    const std::uint64_t below = k + 1 < all.size() ? all[k + 1].below_before : run.counts().below_cutoff;
    if (inside) speeds.add(c.speed);
    if (inside && below == c.below_before) dissipative.add(c.speed);
  }
  for (ParticleIndex p = 0; p < n; ++p) per_particle.add(static_cast<double>(collisions[p]));
  return {free.counts(), pair.counts(), speeds.counts(), dissipative.counts(), per_particle.counts()};
}

TEST(CollisionHistograms, AreThoseOfAListOfAllCollisions) {
  const Inelastic<double> law(0.9, 0.05);
  std::uint64_t below = 0;
  for (const auto& scene : {gas<double>(100, 101.), uniform_rows(300), gaussian_ring(2, 2.),
                            between(0, rmix<double>(40), thermal(-1, 0.5), Wall<double>{41.})}) {
    auto run = gap_run<double>(scene, law);
    std::vector<Listed> all;
    Histogram histogram(5., 40., bins, scene->count(), true);
    const auto add = into(histogram, run);
    run.advance(60, [&](const Collision<double>& c) {
      all.push_back({c.time.value(), c.closing_speed, c.left, c.right, run.counts().below_cutoff});
      add(c);
    });
    histogram.made(run.counts());
    below += run.counts().below_cutoff;
    const std::vector<Counts> found = all_counts(histogram), wanted = counted(all, run, scene->count(), 5, 40);
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k], wanted[k]) << k;
  }
  EXPECT_GT(below, 100U);
}

TEST(CollisionHistograms, AreTheSameInSegmentsAndFromASavedState) {
  using Run = GapRun<double>;
  const Inelastic<double> law(0.98, 1e-2);
  for (const auto& scene :
       {gas<double>(800, 801.), gas<double>(800), between(0, gas<double>(800), thermal(-1, 0.5), Wall<double>{801.})}) {
    Run plain = gap_run<double>(scene, law);
    std::uint64_t slabs = 0;
    Histogram wanted(3., 27., bins, scene->count(), true);
    plain.advance(30, into(wanted, plain));
    wanted.made(plain.counts());
    for (const SegmentsAs& as : segmentations()) {
      Run run = gap_run<double>(scene, law);
      Segments<Inelastic<double>, GapChain<double>> segments(threads(as.threads), as.how);
      Histogram first(3., 27., bins, scene->count(), true), found = first;
      run.advance(13.3, segments, into(first, run));
      first.made(run.counts());
      restore(found, first);
      run.advance(30, segments, into(found, run));
      found.made(run.counts());
      slabs += segments.statistics().slabs;
      EXPECT_EQ(all_counts(found), all_counts(wanted));
    }
    EXPECT_GT(slabs, 10U);
  }
}

TEST(CollisionHistograms, RefuseStatesThatCannotBe) {
  auto run = gap_run<double>(gas<double>(100, 101.), Inelastic<double>(0.9));
  Histogram histogram(0., 9., bins, 100, true), of_fewer(0., 9., bins, 50, true),
      other(0., 9., OctaveBins::of_numbers(1, 2), 100, true);
  run.advance(9, into(histogram, run));
  for (Histogram* wrong : {&of_fewer, &other}) EXPECT_THROW(restore(*wrong, histogram), std::invalid_argument);
}

TEST(Clusters, AreCountedByHand) {
  const auto clusters = [](const std::vector<double>& gaps, bool on_ring) {
    Configuration<double> c;
    c.gap = gaps;
    c.x.resize(gaps.size() + (on_ring ? 0 : 1));
    std::vector<std::size_t> all;
    for_each_cluster(c, 1., [&](std::size_t particles) { all.push_back(particles); });
    return all;
  };
  using Sizes = std::vector<std::size_t>;
  EXPECT_EQ(clusters({.1, .2, 3, 1, .5}, false), (Sizes{3, 1, 2}));
  EXPECT_EQ(clusters({3}, false), (Sizes{1, 1}));
  EXPECT_EQ(clusters({}, false), (Sizes{1}));
  EXPECT_EQ(clusters({.1, .2}, false), (Sizes{3}));
  EXPECT_EQ(clusters({.1, 2, 3, .5}, true), (Sizes{1, 3}));  // the last gap leads to the first particle
  EXPECT_EQ(clusters({.1, 2, 3, 5}, true), (Sizes{2, 1, 1}));
  EXPECT_EQ(clusters({.1, .2, .3}, true), (Sizes{3}));
  EXPECT_EQ(clusters({5}, true), (Sizes{1}));
}

}  // namespace cradle::test::histograms_test
