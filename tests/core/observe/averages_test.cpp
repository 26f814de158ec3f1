// Averages over time. Proves: all numbers of a configuration counted by hand; errors are those of batch means; sums of
// a cold stream do not cancel; batches shorter than what is correlated show.
#include "cradle/core/observe/averages.hpp"

#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::averages_test {

constexpr std::size_t batches = TimeAverages::batches;

void add(TimeAverages& averages, const std::vector<double>& x, const std::vector<double>& v,
         const std::vector<double>& m) {
  averages.find(placed(x, v, m), List<double>(x, v, m), 0.);
  averages.add_found();
}

TEST(TimeAverages, OfAKnownConfiguration) {
  // Bins [0, 2), [2, 4) and [4, 6); the last particle is outside.
  TimeAverages averages({0, 6}, 3, 40);
  for (int k = 0; k < 40; ++k) add(averages, {0.5, 1.5, 3, 7}, {3, -1, 4, 9}, {2, 1, 3, 1});
  EXPECT_TRUE(averages.complete());
  EXPECT_EQ(averages.centres(), (std::vector<double>{1, 3, 5}));
  const auto bins = averages.averages();
  // In the first bin u = 5/3, sum m (v - u)^2 = 19 - 25/3 and sum m (v - u)^3 = 2 (4/3)^3 - (8/3)^3.
  const double second = 19 - 25. / 3, third = (2 * 64 - 512) / 27.;
  const TimeAverages::Numbers first{1, 1.5, 2.5, 4.75, 53 / 4., 5. / 3, second / 2, second / 2, third / 4};
  const TimeAverages::Numbers cold{0.5, 1.5, 6, 12, 48, 4, 0, 0, 0};
  for (std::size_t q = 0; q < TimeAverages::quantities; ++q) {
    EXPECT_NEAR(bins[0].value[q], first[q], 1e-14 * std::abs(first[q])) << q;
    EXPECT_NEAR(bins[0].error[q], 0, 1e-14 * std::abs(first[q])) << q;
    EXPECT_DOUBLE_EQ(bins[1].value[q], cold[q]) << q;
    const bool of_particles = q == 5 || q == 6;  // velocity and temperature
    EXPECT_TRUE(of_particles ? std::isnan(bins[2].value[q]) : bins[2].value[q] == 0) << q;
  }
}

// For the density, which is linear, and for the velocity, whose batches weigh differently, to first order.
TEST(TimeAverages, ErrorsAreThoseOfBatchMeans) {
  TimeAverages averages({0, 1}, 1, 2 * batches);
  std::vector<double> particles, speeds;
  for (std::size_t b = 0; b < batches; ++b) {
    double count = 0, speed = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> x, v;
      for (std::size_t j = 0; j < 40 + (7 * b + 3 * k) % 5; ++j) {
        x.push_back(0.01 * static_cast<double>(j + 1));
        v.push_back(1 + 0.001 * static_cast<double>((b * b + j) % 11));
        speed += v.back();
      }
      count += static_cast<double>(x.size());
      add(averages, x, v, std::vector<double>(x.size(), 1));
    }
    particles.push_back(count / 2), speeds.push_back(speed / count);
  }
  const double of_particles = mean_of(particles).error, of_speeds = mean_of(speeds).error;
  const auto bin = averages.averages().front();
  EXPECT_NEAR(bin.error[0], of_particles, 1e-12 * of_particles);
  // The weights of batches differ by a twentieth from 1, and so do their contributions.
  EXPECT_NEAR(bin.error[5], of_speeds, 0.05 * of_speeds);
  EXPECT_GT(bin.error[0], 0.1);
}

// Velocities 1e6 + 1e-6 and 1e6 - 1e-6 are rounded to 1e-10, a share of 2e-4 of the squares of their differences.
TEST(TimeAverages, OfAColdStreamDoNotCancel) {
  TimeAverages averages({0, 1}, 1, batches);
  for (std::size_t k = 0; k < batches; ++k) add(averages, {0.2, 0.7}, {1e6 + 1e-6, 1e6 - 1e-6}, {1, 1});
  const auto bin = averages.averages().front();
  EXPECT_NEAR(bin.value[6], 1e-12, 4e-16);
  EXPECT_NEAR(bin.value[8], 0, 1e-21);
  EXPECT_EQ(bin.value[5], 1e6);
}

// What stays the same over four batches gives errors half as large as they should be, what changes from one to the
// next right ones.
TEST(TimeAverages, ShowBatchesThatAreTooShort) {
  TimeAverages slow({0, 1}, 1, batches), quick({0, 1}, 1, batches);
  for (std::size_t k = 0; k < batches; ++k) {
    add(slow, {0.5}, {static_cast<double>((k / 4 * 3) % 8 + 1)}, {1});
    add(quick, {0.5}, {static_cast<double>((k * 11) % 32 + 1)}, {1});
  }
  // With 8 of 32 batches the squares are those of the same numbers, over 7 instead of 31.
  EXPECT_NEAR(slow.error_growth(), std::sqrt(31 / 7.), 1e-12);
  EXPECT_LT(quick.error_growth(), 1.3);
  OfBatches sums{}, weights{};
  for (std::size_t b = 0; b < batches; b += 4) sums[b] = static_cast<double>(b * b), weights[b] = 1;
  const BatchMean alone = mean_of_batches(sums, weights);  // no two are in batches that can be joined
  EXPECT_GT(alone.error, 0);
  EXPECT_TRUE(std::isnan(error_growth({alone})));
}

TEST(TimeAverages, ContinueFromASavedState) {
  const auto add_sample = [](TimeAverages& averages, std::size_t k) {
    add(averages, {0.1 + 0.02 * static_cast<double>(k), 0.9}, {1. + static_cast<double>(k), -2}, {1, 3});
  };
  expect_continues(TimeAverages({0, 1}, 2, batches), batches, 13, add_sample, {TimeAverages({0, 1}, 3, batches)});
}

TEST(TimeAverages, WithoutExtentAreRefused) {
  EXPECT_THROW(TimeAverages({1, 1}, 1, batches), std::invalid_argument);
  EXPECT_THROW(TimeAverages({0, 1}, 0, batches), std::invalid_argument);
  EXPECT_THROW(TimeAverages({0, 1}, 1, batches - 1), std::invalid_argument);
}

}  // namespace cradle::test::averages_test
