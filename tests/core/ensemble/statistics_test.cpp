// Statistics over replicas: against exact arithmetic within a derived bound; the same bits in any order, split and
// merged; entries that some replicas lack; counts in fixed bins and quantiles from them.
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <set>
#include <thread>

#include "cradle/core/ensemble/statistics.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/replicas.hpp"

namespace cradle::test::statistics_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Exact {
  Rational mean = 0, squares = 0;
};
Exact exact_statistics(const std::vector<double>& values) {
  Exact exact;
  for (const double x : values) exact.mean += exactly(x);
  exact.mean /= static_cast<long long>(values.size());
  for (const double x : values) exact.squares += (exactly(x) - exact.mean) * (exactly(x) - exact.mean);
  return exact;
}

// Bounds on the rounding of the tree over n replicas with |x| <= X, depth d = ceil(log2 n), unit roundoff u = 2^-53.
// A level computes mean_a + delta share: delta (|delta| <= 2X) with relative error u, share with 2 u (a + b exact),
// their product with u, the sum (at most X) with u: at most 2X 4u + X u = 9 u X, on top of a weighted mean of the
// errors below. So a mean is wrong by at most e = 9 d u X (1 + O(u)); 10 covers the second order.
double mean_bound(double largest, int depth) { return 10 * depth * 0x1p-53 * largest; }
// squares is the sum over the n - 1 inner nodes of g delta^2, g = ab/n, all terms >= 0. delta is off by h <= 2 e + 2 u
// X, the factors by 7 u, and every addition (two a level) by u: in all (7 + 2d) u relative to the sum, and sum g (2
// |delta| h + h^2) <= 2 h sqrt(squares G) + h^2 G, where G = sum of g <= d n/4 (g <= (a + b)/4 at each level).
double squares_bound(double squares, double largest, int depth, std::uint64_t n) {
  const double h = 2 * mean_bound(largest, depth) + 2 * 0x1p-53 * largest;
  const double g = depth * static_cast<double>(n) / 4;
  return 1.01 * ((7 + 2 * depth) * 0x1p-53 * squares + 2 * h * std::sqrt(squares * g) + h * h * g);
}

void expect_exact(const Moments& found, const std::vector<ReplicaIndex>& replicas) {
  const auto depth = static_cast<int>(std::bit_width(*std::max_element(replicas.begin(), replicas.end())));
  ASSERT_EQ(found.replicas, replicas.size());
  for (std::size_t i = 0; i < entries; ++i) {
    std::vector<double> values;
    values.reserve(replicas.size());
    for (const ReplicaIndex k : replicas) values.push_back(values_of(k)[i]);
    const Exact exact = exact_statistics(values);
    const auto [least, greatest] = std::ranges::minmax(values);
    const double largest = std::max(std::abs(least), std::abs(greatest));
    const auto squares = static_cast<double>(exact.squares);
    EXPECT_LE(std::abs(static_cast<double>(exactly(found.mean[i]) - exact.mean)), mean_bound(largest, depth)) << i;
    EXPECT_LE(std::abs(static_cast<double>(exactly(found.squares[i]) - exact.squares)),
              squares_bound(squares, largest, depth, replicas.size()))
        << i;
    EXPECT_EQ(found.least[i], least);
    EXPECT_EQ(found.greatest[i], greatest);
    const auto n = static_cast<double>(replicas.size());
    EXPECT_DOUBLE_EQ(found.standard_error(i), std::sqrt(found.squares[i] / (n - 1) / n));
  }
}

TEST(Statistics, AreThoseOfExactArithmeticWithinRounding) {
  for (const std::uint64_t n : {2U, 3U, 7U, 64U, 1000U})
    expect_exact(statistics_of(first_indices(n)), first_indices(n));
  std::vector<ReplicaIndex> range;
  for (ReplicaIndex k = 123; k < 456; ++k) range.push_back(k);
  expect_exact(statistics_of(range), range);
}

TEST(Statistics, OfOneReplicaAreItsValues) {
  const Moments one = statistics_of({5});
  EXPECT_EQ(one.mean, values_of(5));
  EXPECT_EQ(one.least, values_of(5));
  EXPECT_EQ(one.greatest, values_of(5));
  EXPECT_TRUE(std::isnan(one.standard_error(0)));
}

TEST(Statistics, OfEqualValuesAreThatValueWithoutSpread) {
  MomentTree tree;
  for (ReplicaIndex k = 0; k < 777; ++k) tree.add(k, std::vector<double>{0.1, 1e300});
  EXPECT_EQ(tree.total().mean, (std::vector<double>{0.1, 1e300}));
  EXPECT_EQ(tree.total().squares, (std::vector<double>{0, 0}));
}

TEST(Statistics, DoNotDependOnTheOrderInWhichReplicasCome) {
  std::vector<ReplicaIndex> order = first_indices(300);
  const Moments in_order = statistics_of(order);
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(order.begin(), order.end(), random);
    EXPECT_EQ(statistics_of(order), in_order) << trial;
  }
}

TEST(Statistics, OfAnySplitMergedInAnyOrderAreThoseOfTheWhole) {
  // Ranges that begin anywhere (--first), whose nodes are handed over one by one in a random order.
  std::mt19937 random(2);
  const ReplicaIndex begin = 37, end = 700;
  MomentTree whole;
  for (ReplicaIndex k = begin; k < end; ++k) whole.add(k, values_of(k));
  for (int trial = 0; trial < 20; ++trial) {
    std::set<ReplicaIndex> cuts{begin, end};
    for (int c = 0; c < 6; ++c) cuts.insert(begin + random() % (end - begin));
    std::vector<TreeNode> nodes;
    for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut) {
      MomentTree part;
      for (ReplicaIndex k = *cut; k < *std::next(cut); ++k) part.add(k, values_of(k));
      for (TreeNode& node : part.nodes()) nodes.push_back(std::move(node));
    }
    std::shuffle(nodes.begin(), nodes.end(), random);
    MomentTree merged;
    for (TreeNode& node : nodes) merged.add(std::move(node));
    EXPECT_EQ(merged.total(), whole.total()) << trial;
    EXPECT_EQ(merged.nodes(), whole.nodes()) << trial;
    EXPECT_EQ(merged.size(), end - begin);
  }
}

TEST(Statistics, SkipAndCountMissingEntriesOneByOne) {
  MomentTree with_gaps;
  std::array<MomentTree, 2> by_entry;
  for (ReplicaIndex k = 0; k < 200; ++k) {
    const bool has_first = k % 3 != 0, has_second = k < 10;
    std::vector<double> values{values_of(k)[0], values_of(k)[1], nan};
    if (!has_first) values[0] = nan;
    if (!has_second) values[1] = nan;
    with_gaps.add(k, values);
    by_entry[0].add(k, has_first ? std::optional(std::vector{values[0]}) : std::nullopt);
    by_entry[1].add(k, has_second ? std::optional(std::vector{values[1]}) : std::nullopt);
  }
  const Moments total = with_gaps.total();
  EXPECT_EQ(total.replicas, 200U);
  EXPECT_EQ(total.counts, (std::vector<std::uint64_t>{133, 10, 0}));
  for (std::size_t i = 0; i < 2; ++i) {  // the same bits as if those replicas were not there at all
    const Moments alone = by_entry[i].total();
    EXPECT_EQ(total.mean[i], alone.mean[0]);
    EXPECT_EQ(total.squares[i], alone.squares[0]);
    EXPECT_EQ(total.least[i], alone.least[0]);
    EXPECT_EQ(total.greatest[i], alone.greatest[0]);
    EXPECT_EQ(total.standard_error(i), alone.standard_error(0));
  }
  EXPECT_TRUE(std::isnan(total.standard_error(2)));
}

TEST(Statistics, SetsWithReplicasInCommonAreRefused) {
  MomentTree tree;
  for (ReplicaIndex k = 8; k < 20; ++k) tree.add(k, values_of(k));
  EXPECT_THROW(tree.add(11, values_of(11)), std::invalid_argument);
  EXPECT_THROW(tree.add({0, 4, {}}), std::invalid_argument) << "0 to 15";
  EXPECT_THROW(tree.add({6, 2, {}}), std::invalid_argument) << "not aligned";
  EXPECT_NO_THROW(tree.add({0, 3, {}}));
  EXPECT_EQ(tree.missing({0, 40}), (std::vector<ReplicaRange>{{20, 20}}));
  EXPECT_EQ(tree.present(), (std::vector<ReplicaRange>{{0, 20}}));
  EXPECT_TRUE(tree.contains(19));
  EXPECT_FALSE(tree.contains(20));
}

TEST(Statistics, VectorsOfAnotherLengthAreRefusedAndChangeNothing) {
  MomentTree tree;
  for (ReplicaIndex k = 0; k < 3; ++k) tree.add(k, values_of(k));
  const std::vector<TreeNode> before = tree.nodes();
  EXPECT_THROW(tree.add(3, std::vector<double>(entries - 1)), std::invalid_argument);
  EXPECT_EQ(tree.nodes(), before);
  EXPECT_NO_THROW(tree.add(3, std::nullopt)) << "a replica that failed has no vector";
  EXPECT_EQ(tree.total(), statistics_of({0, 1, 2}));
}

// Vectors so long that the writing thread puts nodes together nearly all the time: a concurrent reader sees every
// replica whose add() has returned, and one replica is never taken twice.
TEST(Statistics, NoReplicaIsOutOfSightWhileOthersAreAdded) {
  constexpr ReplicaIndex n = 64;
  MomentTree tree;
  std::atomic<std::uint64_t> added = 0;
  std::uint64_t unseen = 0, taken_twice = 0, looks = 0;
  std::jthread writer([&] {
    for (ReplicaIndex k = 0; k < n; ++k) tree.add(k, std::vector<double>(100000, 1)), ++added;
  });
  for (std::uint64_t there = 0; there < n; ++looks) {
    there = added;
    if (there == 0) continue;
    unseen += tree.size() < there || !tree.contains(there - 1) || !tree.missing({0, there}).empty();
    try {
      tree.add(looks % there, std::nullopt);
      ++taken_twice;
    } catch (const std::invalid_argument&) {
    }
  }
  writer.join();
  EXPECT_EQ(unseen, 0U) << "of " << looks;
  EXPECT_EQ(taken_twice, 0U) << "of " << looks;
  EXPECT_EQ(tree.nodes().size(), 1U);
}

TEST(Statistics, MissingReplicasAreFoundWhereverTheyAre) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 30; ++trial) {
    MomentTree tree;
    std::set<ReplicaIndex> there;
    for (int i = 0; i < 60; ++i) {
      const ReplicaIndex k = random() % 100;
      if (there.insert(k).second) tree.add(k, std::vector<double>{1});
    }
    std::set<ReplicaIndex> missing;
    for (const ReplicaRange& range : tree.missing({20, 60}))
      for (ReplicaIndex k = range.first; k < range.end(); ++k) missing.insert(k);
    for (ReplicaIndex k = 20; k < 80; ++k) EXPECT_NE(there.contains(k), missing.contains(k)) << k;
    EXPECT_EQ(tree.size(), there.size());
  }
}

// ---- counts in fixed bins, and quantiles from them

TEST(FixedBins, CountEveryValueOnceAndAddExactly) {
  const FixedBins bins{-1, 1, 8};
  EXPECT_EQ(bins.place(-1), 1U);
  EXPECT_EQ(bins.place(std::nextafter(-1, -2)), 0U);
  EXPECT_EQ(bins.place(1), 9U);
  EXPECT_EQ(bins.place(std::nextafter(1.0, 0)), 8U);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(bins.place(bins.edge(k)), k + 1) << "an edge belongs to the bin above";
  // Widths that no double holds: a value just below `to` must not land beyond the last bin.
  for (const std::size_t count : {49U, 100U}) {
    const FixedBins whole{0, static_cast<double>(count), count};
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(whole.place(whole.edge(k)), k + 1) << k << " of " << count;
  }
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
  // All in one bin: between the least and the greatest.
  Histograms wide(FixedBins{0, 100, 2}, 1);
  for (const double x : {1.0, 1.5, 2.0, 3.0}) wide.add(std::span(&x, 1));
  EXPECT_EQ(wide.quantile(0, 0.5, 1, 3), 2);
  EXPECT_EQ(wide.quantile(0, 0.05, 1, 3), 1.1);
}

}  // namespace cradle::test::statistics_test
