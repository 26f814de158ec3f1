// Walls: runs in segments, a gas between thermal ones, and walls that are refused. (Every collision and account against
// exact arithmetic: precision/exact_gas_test.cpp; in double: engine/same_bits_test.cpp.)

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test::walls_test {

TEST(Walls, RunsInSegmentsHaveTheBitsOfThePlainLoop) {
  const auto hot = between<double>(0, gas<double>(800), thermal(-1., 0.4), thermal(801., 0.1));
  auto plain = gap_run(hot, Inelastic<double>(0.98, 1e-3));
  plain.advance(40);
  for (const End end : {End::left, End::right}) EXPECT_GT(plain.chain().walls().tally(end).collisions, 5U);
  const Inelastic<double> law(0.98, 1e-3);
  SlabsMade made = expect_same_in_segments<GapChain<double>>(hot, law, segmentations(), {8., 9., 40.});
  const auto mixed = between<double>(0, gas<double>(800, 0., true), Wall<double>{-1., 0.1, .9}, thermal(801., 0.1));
  made += expect_same_in_segments<GapChain<double, IndividualMasses<double>>>(mixed, law, segmentations(), {9.});
  const auto shock = between<double>(0, uniform_rows(1600), Wall<double>{-805., .8}, {});
  made += expect_same_in_segments<GapChain<double>>(shock, Inelastic<double>(0.98, 0.1), segmentations(), {350.});
  EXPECT_GT(made.slabs, 200U);
}

// Particles that leave a wall of temperature 1 do so with the density v exp(-v^2/2): mean sqrt(pi/2), mean square 2.
TEST(Walls, ThermalSpeedsHaveTheirMoments) {
  constexpr int draws = 100000;
  for (const End end : {End::left, End::right}) {
    double sum = 0, squares = 0, above = 0;
    for (std::uint64_t k = 0; k < draws; ++k) {
      const double v = thermal_speed(3, 1, end, k);
      ASSERT_GT(v, 0);
      sum += v, squares += v * v, above += v > 2;
    }
    EXPECT_NEAR(sum / draws, std::sqrt(std::numbers::pi / 2), 4 * std::sqrt((2 - std::numbers::pi / 2) / draws));
    EXPECT_NEAR(squares / draws, 2, 4 * std::sqrt(4. / draws));
    EXPECT_NEAR(above / draws, std::exp(-2), 4 * std::sqrt(std::exp(-2) / draws));
  }
  EXPECT_NE(thermal_speed(3, 1, End::left, 0), thermal_speed(3, 1, End::right, 0));
  EXPECT_NE(thermal_speed(3, 1, End::left, 0), thermal_speed(3, 2, End::left, 0));
}

// An elastic gas of unequal masses between walls of one temperature takes it on: <E> = N T/2 in time.
TEST(Walls, AGasTakesOnTheirTemperature) {
  constexpr ParticleIndex n = 20;
  std::vector<double> x, v, m;
  for (ParticleIndex i = 0; i < n; ++i) x.push_back(double(i) + 0.5), v.push_back(0), m.push_back(i % 2 ? 2.5 : 1);
  const auto make = [&] {
    const auto particles = between<double>(0, list<double>(x, v, m), thermal(0., 3), thermal(double(n), 3));
    return mass_run<double>(particles, Inelastic<double>(1));
  };
  // Nothing moves until something comes from a wall: a first push.
  auto run = make();
  EXPECT_EQ(run.advance(10), Status::reached);
  EXPECT_EQ(run.counts().collisions, 0U);
  v[0] = -1;
  auto moving = make();
  const auto [mean, error] = block_mean(40, 500, 1, [&](double t) {
    EXPECT_EQ(moving.advance(t), Status::reached);
    return sample(moving, 0.5, t).energy;
  });
  EXPECT_LT(error, 1);
  EXPECT_NEAR(mean, n * 3. / 2, 4 * error);
}

TEST(Walls, WhereTheyCannotBeIsSaid) {
  const auto particles = list<double>({1, 2}, {0, 0});
  EXPECT_THROW(between<double>(0, particles, Wall<double>{1.}, {}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, particles, Wall<double>{1.5}, {}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, particles, {}, Wall<double>{2.}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, particles, Wall<double>{0., 0., 1.5}, {}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, particles, Wall<double>{0., NAN}, {}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, particles, thermal(0., -1), {}), std::invalid_argument);
  EXPECT_THROW(between<double>(0, gaussian_ring(10, 10), Wall<double>{-1.}, {}), std::invalid_argument);
  EXPECT_NO_THROW(between<double>(0, particles, Wall<double>{0.}, Wall<double>{3.}));
}

}  // namespace cradle::test::walls_test
