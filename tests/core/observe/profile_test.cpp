// Profiles over bins. Proves, on configurations whose numbers are known: every particle in range is counted once,
// unreached particles of the rows included; means are weighted by mass; the temperature is the variance of the velocity
// to all digits, also where it is small against the velocity squared.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tests/core/between_walls.hpp"

namespace cradle::test::profile_test {

// Of inelastic particles when they start.
Profile at_start(const Scene<double>& particles, BinRange range, std::size_t bins) {
  return profile(mass_run(particles, Inelastic(0.5)).configuration(0.), *particles, 0., range, bins);
}

double total(const std::vector<double>& density, double width) {
  return width * std::accumulate(density.begin(), density.end(), 0.);
}

TEST(Profile, OfAKnownConfiguration) {
  // Bins [0, 2) and [2, 4); the particle at 5 is outside, the one at rest moves neither way.
  const auto particles = list<double>({0, 0.5, 1.5, 2, 3, 5}, {1, 3, -1, 0, 4, 9}, {1, 2, 1, 6, 2, 1});
  const Profile p = at_start(particles, {0, 4}, 2);
  EXPECT_EQ(p.x, (std::vector<double>{1, 3}));
  EXPECT_EQ(p.density, (std::vector<double>{1.5, 1}));
  EXPECT_EQ(p.mass_density, (std::vector<double>{2, 4}));
  EXPECT_DOUBLE_EQ(p.velocity[0], 6. / 4);
  EXPECT_DOUBLE_EQ(p.velocity[1], 8. / 8);
  EXPECT_DOUBLE_EQ(p.temperature[0], (1 + 18 + 1) / 4. - 1.5 * 1.5);
  EXPECT_DOUBLE_EQ(p.temperature[1], 32. / 8 - 1);
  EXPECT_EQ(p.density_right, (std::vector<double>{1, .5}));
  EXPECT_EQ(p.density_left, (std::vector<double>{.5, 0}));
  EXPECT_EQ(p.velocity_right, (std::vector<double>{2, 4}));
  EXPECT_EQ(p.velocity_left[0], -1);
  EXPECT_TRUE(std::isnan(p.velocity_left[1]));
}

// Merged particles at rest are left with a rounding of their partners' speeds, which is no motion.
TEST(Profile, ARoundingOfTheFastestIsRest) {
  Simulation run(InelasticMerging<double>(Inelastic(0.), 1e9),
                 ClusterChain<double>(list<double>({0, 1, 2, 3}, {0.3, 0.1, -0.3, -0.1}), 0.));
  ASSERT_EQ(run.advance(100.), Status::reached);
  ASSERT_EQ(run.counts().merges, 3U);
  auto c = run.configuration(100.);
  c.v[0] = -1e-17, c.v.push_back(1), c.x.push_back(5), c.m.push_back(1), c.index.push_back(4);
  const Profile p = profile(c, *list<double>({0, 1, 2, 3, 5}, {0.3, 0.1, -0.3, -0.1, 1}), 100., {-9, 9}, 1);
  EXPECT_EQ(p.density_left[0], 0);
  EXPECT_EQ(p.density_right[0], 1. / 18);
}

TEST(Profile, EmptyBinsHaveNoVelocity) {
  const auto particles = list<double>({0, 1}, {0, 0});
  const Profile p = at_start(particles, {10, 20}, 3);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_EQ(p.density[b], 0);
    EXPECT_EQ(p.mass_density[b], 0);
    EXPECT_TRUE(std::isnan(p.velocity[b]) && std::isnan(p.temperature[b]));
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const BinRange range : {BinRange{1, 1}, BinRange{-infinity, infinity}, BinRange{-1.7e308, 1.7e308}})
    EXPECT_THROW(at_start(particles, range, 3), std::invalid_argument) << range.from;
  EXPECT_THROW(at_start(particles, {0, 1}, 0), std::invalid_argument);
}

// The place of a particle in units of bins is rounded, and can come out as their number: not the particle's fault.
TEST(Profile, ParticleJustBelowTheEndIsInTheLastBin) {
  for (const BinRange range : {BinRange{0, 1}, BinRange{-0.3, .7}, BinRange{-400, 400}, BinRange{1e6, 1e6 + .1}}) {
    const std::vector<double> places{range.from, std::nextafter(range.to, range.from)};
    const List<double> particles(places, {0, 0});
    const auto c = placed(places, {0, 0});
    for (std::size_t bins = 1; bins <= 300; ++bins) {
      const Profile p = profile(c, particles, 0., range, bins);
      ASSERT_GT(p.density.front(), 0) << range.from << " to " << range.to << " in " << bins;
      ASSERT_GT(p.density.back(), 0) << range.from << " to " << range.to << " in " << bins;
    }
  }
}

// On a line the last bin has its end, where particles rest on a wall; so two walls are alike.
TEST(Profile, AParticleAtEitherEndIsInABin) {
  for (const double at : {0., 4.}) EXPECT_EQ(total(at_start(list<double>({at}, {0}), {0, 4}, 2).density, 2), 1) << at;
  const auto rows = rshock<double>(40);  // the fronts have reached none of them
  EXPECT_EQ(total(at_start(rows, {rows->position(3), rows->position(7)}, 3).density, 1),
            5 / ((rows->position(7) - rows->position(3)) / 3));
}

// Their velocities are what sums of closing speeds leave of them.
TEST(Profile, ParticlesAtRestMoveNeitherWayInAnyType) {
  const auto at_rest = []<class T>(T tenth) {
    const auto particles = list<T>({T(1), T(2), T(3), T(4), T(5)}, {T(7) * tenth, tenth, T(0), T(0), T(3) * tenth});
    const auto walled = between<T>(T(0), particles, Wall<T>{T(0)}, Wall<T>{T(6)});
    const Profile p = profile(mass_run(walled, Inelastic<T>(T(1))).configuration(T(0)), *walled, T(0), {0, 6}, 6);
    EXPECT_EQ(p.density_left, (std::vector<double>(6, 0.)));
    EXPECT_EQ(p.density_right, (std::vector<double>{0, 1, 1, 0, 0, 1}));
  };
  at_rest(0.1);
  at_rest(0.1L);
}

TEST(Profile, TemperatureKeepsItsDigitsInAFastFrame) {
  // Velocities 1e6 +- 2^-20: variance 2^-40, of which a difference of squares of order 1e12 would keep none.
  std::vector<double> x, v;
  for (int i = 0; i < 100; ++i) {
    x.push_back(i);
    v.push_back(1e6 + std::ldexp(i % 2 == 0 ? 1 : -1, -20));
  }
  const Profile p = at_start(list(x, v), {0, 100}, 1);
  // Differences to the mean are of order 2^-20 and rounded at 2^-33 = 1e6 2^-53.
  EXPECT_NEAR(p.temperature[0], std::ldexp(1, -40), 100 * std::ldexp(1, -40 - 13));
}

// On a ring of length 4 every place has images 4 apart; a range across the seam or of several turns has them.
TEST(Profile, OnARingHasTheImagesOfItsParticles) {
  using Densities = std::vector<double>;
  const auto ring = list<double>({0.5, 1.5, 1.75, 3.5}, {1, 2, 3, 4}, {}, 4);
  const auto density = [&](BinRange range, std::size_t bins) { return at_start(ring, range, bins).density; };
  EXPECT_EQ(density({0, 4}, 4), (Densities{1, 2, 0, 1}));
  EXPECT_EQ(density({-2, 2}, 4), (Densities{0, 1, 1, 2}));
  EXPECT_EQ(density({-101, -97}, 4), (Densities{1, 1, 2, 0}));
  EXPECT_EQ(density({3, 12}, 9), (Densities{1, 1, 2, 0, 1, 1, 2, 0, 1}));
  EXPECT_EQ(density({1.25, 1.75}, 1), (Densities{2}));  // the end is not in it
  EXPECT_EQ(density({0, 0x1p12}, 1), (Densities{1}));   // N/L
  EXPECT_EQ(at_start(ring, {-0.75, -0.25}, 1).velocity, (Densities{4}));
  EXPECT_THROW(density({0, 1e300}, 5), std::invalid_argument);
}

TEST(Profile, CountsEveryParticleOfTheRowsWhetherReachedOrNot) {
  const auto particles = rshock<double>(400);
  for (const double t : {0., 0.25, 10., 100., 250.}) {
    auto streamed = gap_run(particles, Inelastic(0.98, 1e-5));
    auto positions = position_run(particles, Inelastic(0.98, 1e-5));
    streamed.advance(t);
    positions.advance(t);
    const auto from_streamed = profile(configuration_at(streamed, t), *particles, t, {-400, 400}, 80);
    const auto from_positions = profile(configuration_at(positions, t), *particles, t, {-400, 400}, 80);
    EXPECT_DOUBLE_EQ(total(from_streamed.density, 10), 400) << t;
    EXPECT_DOUBLE_EQ(total(from_streamed.mass_density, 10), 400) << t;
    EXPECT_EQ(from_streamed.density, from_positions.density) << t;
    EXPECT_EQ(from_streamed.density_right, from_positions.density_right) << t;
    // Momentum vanishes: the densities times the mean velocities add up to it.
    double momentum = 0, movers = 0;
    for (std::size_t b = 0; b < 80; ++b) {
      if (from_streamed.density[b] == 0) continue;
      momentum += from_streamed.mass_density[b] * from_streamed.velocity[b] * 10;
      movers += (from_streamed.density_right[b] + from_streamed.density_left[b]) * 10;
    }
    EXPECT_NEAR(momentum, 0, 1e-9) << t;  // 400 particles, 1e4 collisions, 2^-53 each
    EXPECT_DOUBLE_EQ(movers, 400) << t;
  }
}

TEST(Profile, RangeMayEndInsideARow) {
  const auto particles = rshock<double>(400);
  auto run = gap_run(particles, Inelastic(0.98));
  run.advance(20);
  // Nothing has reached 50 < x < 150 yet: particles of the right row, one per unit of length.
  const auto p = profile(configuration_at(run, 20.), *particles, 20., {50, 150}, 10);
  for (std::size_t b = 0; b < 10; ++b) {
    EXPECT_EQ(p.density[b], 1);
    EXPECT_EQ(p.density_right[b], 0);
    EXPECT_EQ(p.velocity[b], -0.5);
    EXPECT_EQ(p.temperature[b], 0);
  }
}

// Rows of 1e12 particles: places beyond 2^63 units of 2^-28, exact in double.
TEST(Profile, OfRowsThatNobodyCanWalk) {
  constexpr ParticleIndex half = 500'000'000'000;
  const auto rows = lattice_rows(2 * half);
  EXPECT_EQ(rows->position(0), -499'999'999'999.5);
  EXPECT_EQ(rows->position(2 * half - 1), 499'999'999'999.5);
  const Cold<double> cold(2 * half, 1.0, HotPlace::left, kicked(0, 1.0), still);
  EXPECT_EQ(cold.position(2 * half - 1), 999'999'999'999.0);

  auto run = gap_run<double>(rows, Inelastic(0.5));
  const auto now = configuration_at(run, 0.);
  const Profile far = profile(now, *rows, 0., {4e11, 4e11 + 10}, 2);  // found at once, wherever it is
  EXPECT_EQ(far.density, (std::vector<double>{1, 1}));
  EXPECT_EQ(profile(now, *rows, 0., {-4e11 - 10, -4e11}, 2).density, far.density);
  // Stopped after some calls, whichever row is being walked.
  for (const BinRange range : {BinRange{-4e11, 0}, BinRange{0, 4e11}}) {
    int calls = 0;
    EXPECT_THROW(profile(now, *rows, 0., range, 2, [&] { return ++calls == 5; }), WalkStopped);
    EXPECT_EQ(calls, 5);
    ZoneAverage zone(4e11, 4, 16, 1.);
    const SavedState before = SavedState::of(zone);
    EXPECT_THROW(zone.find(now, *rows, 0., [&] { return ++calls == 10; }), WalkStopped);
    EXPECT_EQ(SavedState::of(zone), before);
  }
}

TEST(GapStatistics, LeastAndMedian) {
  Configuration<double> c;
  c.gap = {3, 1, 4, 1.5, 9};
  EXPECT_EQ(gap_statistics(c).least, 1);
  EXPECT_EQ(gap_statistics(c).median, 3);
  EXPECT_EQ(median(std::vector{4., 1., 7., 2.}), 3);
}

}  // namespace cradle::test::profile_test
