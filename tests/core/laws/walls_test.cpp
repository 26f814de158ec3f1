// Walls: against exact rationals collision by collision, in both coordinates, and in segments; the energy that they
// give, a gas between thermal ones, and walls that are refused.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/segmented.hpp"
#include "cradle/tests/precision/reference_gas.hpp"

namespace cradle::test::walls_test {

// Against a gas that searches all pairs before every collision.
TEST(Walls, MakeTheCollisionsOfExactArithmetic) {
  using R = Rational;
  for (const int moving : {0, 1})
    for (const int inelastic : {0, 1}) {
      const auto scene = list<R>({R(1), R(2), R(7) / 2, R(5)}, {R(1), R(-1) / 3, R(1) / 2, R(-2)});
      auto plain = gas_like(*scene);
      plain.restitution = R(3) / 4;
      plain.walls = {GasWall<R>{R(0), R(moving) / 16, inelastic ? R(1) / 3 : R(1)},
                     GasWall<R>{R(6), R(-moving) / 32, inelastic ? R(7) / 8 : R(1)}};
      const auto wall = [&](std::size_t side) {
        return Wall<R>{plain.walls[side]->origin, plain.walls[side]->v, plain.walls[side]->restitution};
      };
      const auto particles = between<R>(R(0), scene, wall(0), wall(1));
      auto run = gap_run<R>(particles, Inelastic<R>(plain.restitution));
      auto twin = position_run<R>(particles, Inelastic<R>(plain.restitution));
      const R energy = plain.energy(), until = R(11);
      std::vector<ParticleIndex> wanted, seen, seen_by_twin;
      while (plain.next(until)) wanted.push_back(*plain.latest);
      plain.advance(until);
      EXPECT_FALSE(plain.tied);
      EXPECT_EQ(run.advance(until, [&](const Collision<R>& c) { seen.push_back(c.left); }), Status::reached);
      EXPECT_EQ(twin.advance(until, [&](const Collision<R>& c) { seen_by_twin.push_back(c.left); }), Status::reached);
      EXPECT_GE(wanted.size(), 10U);
      EXPECT_EQ(seen, wanted);
      EXPECT_EQ(seen_by_twin, wanted);
      for (const auto& c : {configuration_at(run, until), configuration_at(twin, until)}) {
        ASSERT_EQ(c.x.size(), plain.cells.size());
        for (std::size_t b = 0; b < c.x.size(); ++b) {
          EXPECT_EQ(c.x[b], plain.place(plain.cells[b]));
          EXPECT_EQ(c.v[b], plain.velocity(plain.cells[b]));
        }
        EXPECT_EQ(c.gap.size(), 3U);
        EXPECT_EQ(c.closure_gap.value_or(R(0)), 0);
      }
      for (const auto& s : {sample(run, energy, until), sample(twin, energy, until)}) {
        EXPECT_EQ(s.energy, plain.energy());
        EXPECT_EQ(energy - s.energy_lost + s.given, s.energy);
        for (const std::size_t side : {0U, 1U}) {
          EXPECT_EQ(s.walls[side].collisions, plain.walls[side]->collisions);
          EXPECT_EQ(s.walls[side].given.value(), plain.walls[side]->given);
          EXPECT_EQ(s.walls[side].momentum.value(), plain.walls[side]->momentum);
          EXPECT_EQ(s.walls[side].dissipated.value(), plain.walls[side]->lost);
        }
        EXPECT_EQ(s.particles, 4);
        EXPECT_EQ(*s.front_left, plain.place(plain.cells.front()));
        EXPECT_EQ(*s.front_right, plain.place(plain.cells.back()));
      }
    }
}

// A wall of the particles' own restitution at x = 0 is a mirror: N particles beside it and 2 N in free space are the
// same.
TEST(Walls, AreMirrorsOfTheParticles) {
  using R = Rational;
  const R eps = R(3) / 5, until = R(20);
  const std::vector<R> x{R(1), R(5) / 2, R(3), R(5)}, v{R(-1), R(-1) / 2, R(-2), R(-3)};
  std::vector<R> places, speeds;
  for (std::size_t b = x.size(); b-- > 0;) places.push_back(-x[b]), speeds.push_back(-v[b]);
  places.insert(places.end(), x.begin(), x.end()), speeds.insert(speeds.end(), v.begin(), v.end());
  auto run = gap_run<R>(between<R>(R(0), list(x, v), Wall<R>{R(0), R(0), eps}, {}), Inelastic<R>(eps));
  auto mirrored = gap_run<R>(list(places, speeds), Inelastic<R>(eps));
  std::uint64_t at_wall = 0;
  run.advance(until, [&](const Collision<R>& c) { at_wall += c.left < 0; });
  mirrored.advance(until);
  EXPECT_GT(at_wall, 4U);
  EXPECT_EQ(mirrored.counts().collisions, 2 * run.counts().collisions - at_wall);
  const auto here = configuration_at(run, until), there = configuration_at(mirrored, until);
  EXPECT_EQ(here.x, std::vector<R>(there.x.begin() + 4, there.x.end()));
  EXPECT_EQ(here.v, std::vector<R>(there.v.begin() + 4, there.v.end()));
  EXPECT_EQ(R(2) * run.energy_lost(), mirrored.energy_lost());
}

TEST(Walls, AParticleBetweenThemGoesToAndFro) {
  const auto particles = between<double>(0, list<double>({.25}, {1}), Wall<double>{0.}, Wall<double>{1.});
  auto run = gap_run<double>(particles, Inelastic<double>(1));
  run.advance(1000);
  EXPECT_EQ(run.counts().collisions, 1000U);
  EXPECT_EQ(configuration_at(run, 1000.).x, std::vector{.25});
  EXPECT_EQ(run.collided_particles(), 1);
  EXPECT_EQ(run.energy_lost(), 0);
}

// A piston of speed V that meets a particle at rest gives it 2 V; the particle never comes back.
TEST(Walls, APistonKicks) {
  const auto particles = between<double>(0, list<double>({1}, {0}), Wall<double>{0., .5}, {});
  auto run = gap_run<double>(particles, Inelastic<double>(1));
  run.advance(10);
  EXPECT_EQ(run.counts().collisions, 1U);
  EXPECT_EQ(configuration_at(run, 10.).v, std::vector{1.});
  EXPECT_EQ(configuration_at(run, 10.).x, std::vector{9.});
  const auto now = sample(run, 0., 10.);
  EXPECT_EQ(now.energy, 0.5);
  EXPECT_EQ(now.given, 0.5);
  EXPECT_EQ(now.walls[0].momentum.value(), 1);
  EXPECT_EQ(now.energy_lost, 0);
}

TEST(Walls, InelasticParticlesAtAWallLoseWhatTheLedgerSays) {
  const auto particles = between<double>(0, rmix<double>(60), Wall<double>{-1., 0., .9}, Wall<double>{61., -0.01, .8});
  auto run = gap_run<double>(particles, Inelastic<double>(0.95, 1e-3));
  EXPECT_EQ(run.advance(300), Status::reached);
  EXPECT_GT(run.counts().collisions, 1000U);
  const double before = particles->kinetic_energy();
  const auto now = sample(run, before, 300.);
  const auto c = configuration_at(run, 300.);
  EXPECT_NEAR(kinetic_energy(c, *particles, c.time), now.energy, 1e-13 * before);
  EXPECT_NEAR(before - now.energy_lost + now.given, now.energy, 1e-13 * before);
  EXPECT_LT(std::abs(*c.closure_gap), 1e-11);
  EXPECT_TRUE(guards_hold(run, *particles, 300.));
}

TEST(Walls, RunsInSegmentsHaveTheBitsOfThePlainLoop) {
  const auto hot = between<double>(0, gas<double>(800), thermal(-1., 0.4), thermal(801., 0.1));
  auto plain = gap_run(hot, Inelastic<double>(0.98, 1e-3));
  plain.advance(40);
  for (const End end : {End::left, End::right}) EXPECT_GT(plain.chain().walls().tally(end).collisions, 5U);
  SlabsMade made;
  for (const auto& as : segmentations()) {
    made += expect_same_in_segments<GapChain<double>>(hot, Inelastic<double>(0.98, 1e-3), as, {8., 9., 40.});
    const auto mixed = between<double>(0, gas<double>(800, 0., true), Wall<double>{-1., 0.1, .9}, thermal(801., 0.1));
    made += expect_same_in_segments<GapChain<double, IndividualMasses<double>>>(mixed, Inelastic<double>(0.98, 1e-3),
                                                                                as, {9.});
    const auto shock = between<double>(0, uniform_rows(1600), Wall<double>{-805., .8}, {});
    made += expect_same_in_segments<GapChain<double>>(shock, Inelastic<double>(0.98, 0.1), as, {350.});
  }
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
