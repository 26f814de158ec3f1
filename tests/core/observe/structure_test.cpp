// Structure factors and pair distributions. Proves: sine and cosine to 2^-51, exact at quarters; both measures against
// sums over all particles and pairs in the plainest way; lattices, two particles; means over samples with the errors of
// batch means, from a saved state too.
#include "cradle/core/observe/structure.hpp"

#include <complex>
#include <random>

#include "cradle/core/observe/batch_means.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::structure_test {

TEST(Turns, HaveTheirSineAndCosine) {
  std::mt19937_64 random(1);
  double largest = 0;
  for (int k = 0; k < 200'000; ++k) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    const double y = std::ldexp(share - 0.5, k % 40);
    // The angle without whole turns is exact; sine and cosine of long doubles are right to 2^-63.
    const long double angle = 2 * std::numbers::pi_v<long double> * (static_cast<long double>(y) - std::round(y));
    const UnitVector at = at_turns(y);
    for (const long double error : {at.cos - std::cos(angle), at.sin - std::sin(angle)})
      largest = std::max(largest, static_cast<double>(std::abs(error)));
  }
  EXPECT_LT(largest, 0x1p-51);
  EXPECT_GT(largest, 0x1p-54);
  const auto expect = [](double turns, double cos, double sin) {
    EXPECT_EQ(at_turns(turns).cos, cos) << turns;
    EXPECT_EQ(at_turns(turns).sin, sin) << turns;
  };
  for (const double turns : {0., 3., -7., 1e6})
    expect(turns, 1, 0), expect(turns + 0.25, 0, 1), expect(turns + 0.5, -1, 0), expect(turns - 0.25, 0, -1);
}

// Particles on a line, of which the first two and the last have not been reached: they fly from where they began.
struct Gas {
  Scene<double> particles;
  Configuration<double> now;
  double elapsed = 2;
  std::vector<double> x, m;
};
Gas gas(std::size_t count, double length, unsigned seed) {
  std::mt19937_64 random(seed);
  Gas gas;
  for (std::size_t j = 0; j < count; ++j) gas.x.push_back(length * static_cast<double>(random() >> 11) * 0x1p-53);
  std::sort(gas.x.begin(), gas.x.end());
  std::vector<double> v(count, 0.001), start;
  for (std::size_t j = 0; j < count; ++j) {
    gas.m.push_back(1 + static_cast<double>(j % 5));
    start.push_back(gas.x[j] - v[j] * gas.elapsed);
  }
  gas.particles = list(start, v, gas.m);
  const std::size_t from = count > 4 ? 2 : 0, to = count > 4 ? count - 1 : count;
  gas.now.from = static_cast<ParticleIndex>(from), gas.now.to = static_cast<ParticleIndex>(to) - 1;
  for (std::size_t j = from; j < to; ++j) {
    gas.now.x.push_back(gas.x[j]), gas.now.v.push_back(v[j]), gas.now.m.push_back(gas.m[j]);
    gas.now.index.push_back(static_cast<ParticleIndex>(j));
  }
  return gas;
}

TEST(StructureFactor, IsThatOfASumOverAllParticles) {
  const Gas found = gas(50, 40, 3);
  const StructureFactor factor(40, 300);
  const auto k = factor.wave_numbers();
  const auto waves = octave_steps(300);
  const auto S = factor(found.now, *found.particles, found.elapsed);
  ASSERT_EQ(S.size(), waves.size());
  for (std::size_t w = 0; w < waves.size(); ++w) {
    EXPECT_DOUBLE_EQ(k[w], 2 * std::numbers::pi * static_cast<double>(waves[w]) / 40);
    std::complex<long double> sum;
    long double squares = 0;
    for (std::size_t j = 0; j < found.x.size(); ++j) {
      const long double mass = found.m[j], phase = 2 * std::numbers::pi_v<long double> *
                                                   static_cast<long double>(waves[w]) *
                                                   static_cast<long double>(found.x[j]) / 40;
      sum += mass * std::complex<long double>(std::cos(phase), std::sin(phase));
      squares += mass * mass;
    }
    // Phases are right to 2^-52 of n turns; 50 particles.
    EXPECT_NEAR(S[w], static_cast<double>(std::norm(sum) / squares), 1e-11) << waves[w];
  }
}

TEST(StructureFactor, OfALatticeIsItsReciprocal) {
  std::vector<double> x, v(32);
  for (int j = 0; j < 32; ++j) x.push_back(0.5 * j + 0.1);
  const auto S = StructureFactor(16, 128)(placed(x, v, std::vector<double>(32, 2)), *list(x, v), 0.);
  const auto waves = octave_steps(128);
  for (std::size_t w = 0; w < waves.size(); ++w) EXPECT_NEAR(S[w], waves[w] % 32 == 0 ? 32 : 0, 1e-12) << waves[w];
}

TEST(PairDistribution, IsThatOfAllPairsOneByOne) {
  for (const bool ring : {true, false}) {
    constexpr double length = 30;
    const Gas found = gas(60, length, 5);
    const double farthest = ring ? 15 : 28;
    constexpr std::size_t bins = 25;
    const PairDistribution pairs(farthest, bins, length, ring);
    std::vector<double> count(bins);
    for (std::size_t i = 0; i < 60; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double apart = std::abs(found.x[i] - found.x[j]);
        if (ring) apart = std::min(apart, length - apart);
        if (apart < farthest) count[static_cast<std::size_t>(apart / farthest * bins)] += 1;
      }
    const auto g = pairs(found.now, *found.particles, found.elapsed);
    const auto centres = pairs.centres();
    ASSERT_EQ(g.size(), bins);
    for (std::size_t b = 0; b < bins; ++b) {
      EXPECT_DOUBLE_EQ(centres[b], (static_cast<double>(b) + 0.5) * farthest / bins);
      // Two points of a line are at a distance r with the density 2 (L - r)/L^2, of a ring with 2/L.
      const double share = farthest / bins * 2 / length * (ring ? 1 : 1 - centres[b] / length);
      EXPECT_NEAR(g[b], count[b] / (60 * 59 / 2 * share), 1e-12 * g[b]) << b;
    }
  }
}

TEST(PairDistribution, OfFewParticles) {
  const PairDistribution pairs(5, 5, 10, true);
  const auto g = pairs(placed({1, 9}, {0, 0}), *list<double>({1, 9}, {0, 0}), 0.);  // 2 apart over the seam
  for (std::size_t bin = 0; bin < 5; ++bin) EXPECT_DOUBLE_EQ(g[bin], bin == 2 ? 5 : 0);
  for (const double alone : pairs(placed({1}, {0}), *list<double>({1}, {0}), 0.)) EXPECT_TRUE(std::isnan(alone));
  EXPECT_THROW(PairDistribution(6, 5, 10, true), std::invalid_argument);
  EXPECT_THROW(PairDistribution(11, 5, 10, false), std::invalid_argument);
  EXPECT_THROW(PairDistribution(5, 0, 10, false), std::invalid_argument);
  EXPECT_THROW(StructureFactor(0, 10), std::invalid_argument);
}

TEST(Places, CanBeStopped) {
  const Gas found = gas(50, 40, 3);
  int calls = 0;
  const auto stopped = [&] { return ++calls > 2; };
  EXPECT_THROW(StructureFactor(40, 300)(found.now, *found.particles, found.elapsed, stopped), WalkStopped);
  calls = 2;
  EXPECT_THROW(PairDistribution(5, 5, 40, false)(found.now, *found.particles, found.elapsed, stopped), WalkStopped);
}

TEST(SampledMeans, HaveTheErrorsOfBatchMeans) {
  SampledMeans means(2, 3 * mean_batches);
  std::vector<double> batches(mean_batches);
  for (std::size_t k = 0; k < 3 * mean_batches; ++k) {
    const double x = static_cast<double>(k * k % 17);
    means.add({x, 4});
    batches[k / 3] += x / 3;
  }
  EXPECT_TRUE(means.complete());
  const auto found = means.means();
  EXPECT_DOUBLE_EQ(found[0].mean, mean_of(batches).mean);
  EXPECT_NEAR(found[0].error, mean_of(batches).error, 1e-12);
  EXPECT_EQ(found[1].mean, 4);
  EXPECT_NEAR(found[1].error, 0, 1e-14);
}

TEST(SampledMeans, OfFewSamplesHaveABatchEach) {
  SampledMeans few(1, 3), one(1, 1);
  for (const double x : {1., 2., 6.}) few.add({x});
  EXPECT_EQ(few.means()[0].mean, 3);
  EXPECT_NEAR(few.means()[0].error, std::sqrt(14 / 6.), 1e-12);
  one.add({5});
  EXPECT_EQ(one.means()[0].mean, 5);
  EXPECT_TRUE(std::isnan(one.means()[0].error));
  EXPECT_TRUE(std::isnan(SampledMeans(1, 1).means()[0].mean));
}

TEST(SampledMeans, ContinueFromASavedState) {
  const auto add = [](SampledMeans& means, std::size_t k) { means.add({0.1 * static_cast<double>(k)}); };
  expect_continues(SampledMeans(1, 50), 50, 13, add, {SampledMeans(2, 50)});
}

}  // namespace cradle::test::structure_test
