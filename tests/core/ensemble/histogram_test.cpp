// Counts in fixed bins and quantiles from them.

#include "cradle/core/ensemble/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cradle/core/base/counter_rng.hpp"

namespace cradle::test::histogram_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(FixedBins, CountEveryValueOnceAndAddExactly) {
  const FixedBins bins{-1, 1, 8};
  EXPECT_EQ(bins.place(-1), 1U);
  EXPECT_EQ(bins.place(std::nextafter(-1, -2)), 0U);
  EXPECT_EQ(bins.place(1), 9U);
  EXPECT_EQ(bins.place(std::nextafter(1.0, 0)), 8U);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(bins.place(bins.edge(k)), k + 1) << "an edge belongs to the bin above";
  // Widths that no double holds: a value just below `to` must not land beyond the last bin.
  const FixedBins thirds{0, 0.3, 3};
  EXPECT_EQ(thirds.place(std::nextafter(0.3, 0)), 3U);

  Histograms whole(bins, 2), part(bins, 2), rest(bins, 2);
  for (std::uint64_t k = 0; k < 100; ++k) {
    const std::vector<double> values{static_cast<double>(k) / 40 - 1.2, k % 2 == 0 ? nan : 0.0};
    whole.add(values);
    (k < 33 ? part : rest).add(values);
  }
  rest.add(part);
  EXPECT_EQ(whole, rest);
  const auto sum = [&](std::size_t entry) {
    const auto counts = whole.counts(entry);
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  };
  EXPECT_EQ(sum(0), 100U);
  EXPECT_EQ(sum(1), 50U);
  EXPECT_EQ(whole.counts(0)[0], 8U) << "-1.2 to -1.025";
}

TEST(FixedBins, QuantilesAreRightToABin) {
  const FixedBins bins{0, 1, 50};
  Histograms histograms(bins, 1);
  std::vector<double> values;
  for (std::uint64_t k = 0; k < 2001; ++k) {
    const double uniform = static_cast<double>(random_bits(1, k, 0) >> 11) * 0x1p-53;
    values.push_back(uniform * uniform);
    histograms.add(std::span(&values.back(), 1));
  }
  std::sort(values.begin(), values.end());
  for (const double p : {0.05, 0.25, 0.5, 0.9, 0.99})
    EXPECT_NEAR(histograms.quantile(0, p), values[static_cast<std::size_t>(p * 2000)], 1.0 / 50) << p;
  // Half of the values below all bins: the median is the first edge, less than that is not known.
  Histograms low(bins, 1);
  for (const double x : {-1.0, 0.5}) low.add(std::span(&x, 1));
  EXPECT_TRUE(std::isnan(low.quantile(0, 0.4)));
  EXPECT_TRUE(std::isnan(Histograms(bins, 1).quantile(0, 0.5)));
}

}  // namespace cradle::test::histogram_test
