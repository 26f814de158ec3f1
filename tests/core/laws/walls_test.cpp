// Walls: against exact rationals collision by collision, in both coordinates, streamed, in segments and from a saved
// state; the energy that they give, a gas between thermal ones, and walls that are refused.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/saved.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace walls_test {

using namespace cradle;
using namespace cradle::test;

template <class T>
std::shared_ptr<const Particles<T>> walled(const Scene<T>& particles, std::optional<Wall<T>> left,
                                           std::optional<Wall<T>> right) {
  return std::make_shared<Walled<T>>(particles, std::move(left), std::move(right));
}
template <class T> Wall<T> thermal(const T& position, double temperature) {
  return {.position = position, .temperature = temperature, .seed = 5, .replica = 2};
}

// The plainest gas between walls there is: positions and velocities, all pairs compared before every collision.
template <class T> struct PlainGas {
  std::vector<T> x, v, m;
  T left, right, speed_left, speed_right, restitution_left, restitution_right, restitution;
  T time{0}, lost{0};
  WallTallies<T> walls = {};

  // Makes the next collision at a time <= until; returns its gap, numbered by the particle on its left, or -2.
  ParticleIndex step(const T& until) {
    const auto n = static_cast<ParticleIndex>(x.size());
    std::optional<T> first;
    ParticleIndex at = -2;
    const auto place = [&](ParticleIndex b) { return b < 0 ? left : b == n ? right : x[std::size_t(b)]; };
    const auto speed = [&](ParticleIndex b) { return b < 0 ? speed_left : b == n ? speed_right : v[std::size_t(b)]; };
    for (ParticleIndex g = -1; g < n; ++g) {
      const T closing = speed(g) - speed(g + 1);
      if (!(closing > T(0))) continue;
      const T wait = (place(g + 1) - place(g)) / closing;
      if (!first || wait < *first) first = wait, at = g;
    }
    if (!first || time + *first > until) return fly(T(until - time)), -2;
    fly(*first);
    const T closing = speed(at) - speed(at + 1);
    const T before = energy();
    if (at < 0 || at + 1 == n) {
      const std::size_t side = at < 0 ? 0 : 1;
      const T r = side == 0 ? restitution_left : restitution_right, mass = side == 0 ? m[0] : m.back();
      const T momentum = mass * (T(1) + r) * (side == 0 ? closing : T(-closing));
      walls[side].collisions += 1;
      walls[side].momentum.add(momentum);
      walls[side].given.add(momentum * (side == 0 ? speed_left : speed_right));
      walls[side].dissipated.add(mass * (T(1) - r * r) * closing * closing / T(2));
      lost += mass * (T(1) - r * r) * closing * closing / T(2);
    }
    if (at < 0)
      v[0] = speed_left + restitution_left * closing;
    else if (at + 1 == n)
      v.back() = speed_right - restitution_right * closing;
    else {
      const auto l = std::size_t(at), r = l + 1;
      const T impulse = (T(1) + restitution) * closing * m[l] * m[r] / (m[l] + m[r]);
      v[l] -= impulse / m[l];
      v[r] += impulse / m[r];
    }
    if (at >= 0 && at + 1 < n) lost += before - energy();
    return at;
  }
  T energy() const {
    T twice(0);
    for (std::size_t b = 0; b < x.size(); ++b) twice += m[b] * v[b] * v[b];
    return twice / T(2);
  }
  void fly(const T& span) {
    for (std::size_t b = 0; b < x.size(); ++b) x[b] += v[b] * span;
    left += speed_left * span, right += speed_right * span, time += span;
  }
};

TEST(Walls, MakeTheCollisionsOfExactArithmetic) {
  using R = Rational;
  const R eps = R(3) / 4;
  for (const int moving : {0, 1})
    for (const int inelastic : {0, 1}) {
      PlainGas<R> plain{{R(1), R(2), R(7) / 2, R(5)},
                        {R(1), R(-1) / 3, R(1) / 2, R(-2)},
                        {R(1), R(1), R(1), R(1)},
                        R(0),
                        R(6),
                        R(moving) / 16,
                        R(-moving) / 32,
                        inelastic ? R(1) / 3 : R(1),
                        inelastic ? R(7) / 8 : R(1),
                        eps};
      const auto particles =
          walled<R>(list(plain.x, plain.v), Wall<R>{plain.left, plain.speed_left, plain.restitution_left},
                    Wall<R>{plain.right, plain.speed_right, plain.restitution_right});
      auto run = gap_run<R>(particles, Inelastic<R>(eps));
      auto twin = position_run<R>(particles, Inelastic<R>(eps));
      const R energy = plain.energy(), until = R(11);
      std::vector<ParticleIndex> wanted, seen, seen_by_twin;
      for (ParticleIndex gap; (gap = plain.step(until)) != -2;) wanted.push_back(gap);
      EXPECT_EQ(run.advance(until, [&](const Collision<R>& c) { seen.push_back(c.left); }), Status::reached);
      EXPECT_EQ(twin.advance(until, [&](const Collision<R>& c) { seen_by_twin.push_back(c.left); }), Status::reached);
      EXPECT_GE(wanted.size(), 10U);
      EXPECT_EQ(seen, wanted);
      EXPECT_EQ(seen_by_twin, wanted);
      for (const auto& c : {configuration_at(run, until), configuration_at(twin, until)}) {
        EXPECT_EQ(c.x, plain.x);
        EXPECT_EQ(c.v, plain.v);
        EXPECT_EQ(c.gap.size(), 3U);
        EXPECT_EQ(c.closure_gap.value_or(R(0)), 0);
      }
      const Sample<R> now = sample(run, energy, until), by_twin = sample(twin, energy, until);
      for (const auto& s : {now, by_twin}) {
        EXPECT_EQ(s.energy, plain.energy());
        EXPECT_EQ(s.energy_lost, plain.lost);
        EXPECT_EQ(energy - s.energy_lost + s.given, s.energy);
        for (const std::size_t side : {0U, 1U}) {
          EXPECT_EQ(s.walls[side].collisions, plain.walls[side].collisions);
          EXPECT_EQ(s.walls[side].given.value(), plain.walls[side].given.value());
          EXPECT_EQ(s.walls[side].momentum.value(), plain.walls[side].momentum.value());
          EXPECT_EQ(s.walls[side].dissipated.value(), plain.walls[side].dissipated.value());
        }
        EXPECT_EQ(s.particles, 4);
        EXPECT_EQ(*s.front_left, plain.x.front());
        EXPECT_EQ(*s.front_right, plain.x.back());
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
  auto run = gap_run<R>(walled<R>(list(x, v), Wall<R>{R(0), R(0), eps}, {}), Inelastic<R>(eps));
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
  const auto particles = walled<double>(list<double>({.25}, {1}), Wall<double>{0.}, Wall<double>{1.});
  auto run = gap_run<double>(particles, Inelastic<double>(1));
  run.advance(1000);
  EXPECT_EQ(run.counts().collisions, 1000U);
  EXPECT_EQ(configuration_at(run, 1000.).x, std::vector{.25});
  EXPECT_EQ(run.collided_particles(), 1);
  EXPECT_EQ(run.energy_lost(), 0);
}

// A piston of speed V that meets a particle at rest gives it 2 V; the particle never comes back.
TEST(Walls, APistonKicks) {
  const auto particles = walled<double>(list<double>({1}, {0}), Wall<double>{0., .5}, {});
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
  const auto particles = walled<double>(rmix<double>(60), Wall<double>{-1., 0., .9}, Wall<double>{61., -0.01, .8});
  auto run = gap_run<double>(particles, Inelastic<double>(0.95, 1e-3));
  const double before = particles->kinetic_energy();
  EXPECT_EQ(run.advance(300), Status::reached);
  EXPECT_GT(run.counts().collisions, 1000U);
  const auto now = sample(run, before, 300.);
  const auto c = configuration_at(run, 300.);
  EXPECT_NEAR(kinetic_energy(c, *particles, c.time), now.energy, 1e-13 * before);
  EXPECT_NEAR(before - now.energy_lost + now.given, now.energy, 1e-13 * before);
  EXPECT_LT(std::abs(*c.closure_gap), 1e-11);
  const auto check =
      guarded(c, *particles, run.counts().collisions, now.energy, 300., run.last_collision_time(), 0., true);
  EXPECT_FALSE(check.broken);
}

template <class Run> void expect_same_piecewise(Run once) {
  Run often = once;
  once.advance(60);
  for (double t = 0; t <= 60; t += 0.37) often.advance(t);
  often.advance(60);
  EXPECT_TRUE(identical(configuration_at(once, 60.), configuration_at(often, 60.)));
  EXPECT_EQ(once.energy_lost(), often.energy_lost());
  EXPECT_TRUE(SavedState::of(once.chain().walls()) == SavedState::of(often.chain().walls()));
}

TEST(Walls, GiveTheSameAtAnyCadence) {
  const auto particles = walled<double>(rmix<double>(40), thermal(-1., 0.5), Wall<double>{41., -.02});
  expect_same_piecewise(gap_run<double>(particles, Inelastic<double>(0.97, 1e-4)));
  expect_same_piecewise(position_run<double>(particles, Inelastic<double>(0.97, 1e-4)));
}

TEST(Walls, RowsAreStreamedTowardsAnEndWithoutOne) {
  const auto particles = walled<double>(uniform_rows(400), Wall<double>{-205., .8}, {});
  auto streamed = gap_run<double>(particles, Inelastic<double>(0.99, 0.1)),
       held = gap_run<double>(particles, Inelastic<double>(0.99, 0.1), {}, 0., {.hold_all = true});
  for (const double t : {20., 40., 120.}) {
    streamed.advance(t);
    held.advance(t);
    EXPECT_TRUE(identical(configuration_at(streamed, t), configuration_at(held, t)));
    EXPECT_EQ(sample(streamed, 50., t).given, sample(held, 50., t).given);
  }
  EXPECT_LT(streamed.chain().last() - streamed.chain().first(), held.chain().last() - held.chain().first() + 1);
  EXPECT_GT(streamed.counts().collisions, 1000U);
}

TEST(Walls, RunsInSegmentsHaveTheBitsOfThePlainLoop) {
  SlabsMade made;
  for (const auto& as : segmentations()) {
    const auto hot = walled<double>(gas<double>(800), thermal(-1., 0.4), thermal(801., 0.1));
    made += expect_same_in_segments<GapChain<double>>(hot, Inelastic<double>(0.98, 1e-3), as, {8., 9.});
    const auto mixed = walled<double>(gas<double>(800, 0., true), Wall<double>{-1., 0.1, .9}, thermal(801., 0.1));
    made += expect_same_in_segments<GapChain<double, IndividualMasses<double>>>(mixed, Inelastic<double>(0.98, 1e-3),
                                                                                as, {9.});
    const auto shock = walled<double>(uniform_rows(1600), Wall<double>{-805., .8}, {});
    made += expect_same_in_segments<GapChain<double>>(shock, Inelastic<double>(0.98, 0.1), as, {350.});
  }
  EXPECT_GT(made.slabs, 200U);
}

TEST(Walls, SegmentsReportWhatWallsGave) {
  const auto hot = walled<double>(gas<double>(800), thermal(-1., 0.4), thermal(801., 0.1));
  using Chain = GapChain<double>;
  const Inelastic<double> law(0.98, 1e-3);
  Simulation<double, Inelastic<double>, Chain> plain(law, Chain(hot, 0.)), segmented(law, Chain(hot, 0.));
  Segments<Inelastic<double>, Chain> segments(threads(2), {.gaps = 40, .ghosts = 12, .anywhere = true});
  plain.advance(40);
  segmented.advance(40, segments);
  for (const End end : {End::left, End::right}) EXPECT_GT(plain.chain().walls().tally(end).collisions, 5U);
  EXPECT_TRUE(SavedState::of(plain.chain().walls()) == SavedState::of(segmented.chain().walls()));
}

TEST(Walls, RunsContinueFromASavedState) {
  const auto particles = walled<double>(rmix<double>(30), thermal(-1., 0.5), Wall<double>{31., -0.02, .9});
  const Inelastic<double> law(0.97, 1e-4);
  const auto check = [](const auto& later, const auto& whole) {
    EXPECT_TRUE(SavedState::of(later.chain().walls()) == SavedState::of(whole.chain().walls()));
  };
  expect_same_from_anywhere([&] { return gap_run<double>(particles, law); }, 0.5, 6.1, 30, check);
  expect_same_from_anywhere([&] { return position_run<double>(particles, law); }, 0.5, 6.1, 30, check);
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
    const auto particles = walled<double>(list<double>(x, v, m), thermal(0., 3), thermal(double(n), 3));
    return mass_run<double>(particles, Inelastic<double>(1));
  };
  // Nothing moves until something comes from a wall: a first push.
  auto run = make();
  EXPECT_EQ(run.advance(10), Status::reached);
  EXPECT_EQ(run.counts().collisions, 0U);
  v[0] = -1;
  auto moving = make();
  double sum = 0, squares = 0;
  constexpr int blocks = 40;
  for (int block = 0; block < blocks + 4; ++block) {
    double mean = 0;
    for (int k = 0; k < 500; ++k) {
      const double t = 500. * block + k + 1;
      moving.advance(t);
      mean += sample(moving, 0.5, t).energy / 500;
    }
    if (block >= 4) sum += mean, squares += mean * mean;
  }
  const double mean = sum / blocks, error = std::sqrt((squares / blocks - mean * mean) / (blocks - 1));
  EXPECT_LT(error, 1);
  EXPECT_NEAR(mean, n * 3. / 2, 4 * error);
}

TEST(Walls, WhereTheyCannotBeIsSaid) {
  const auto particles = list<double>({1, 2}, {0, 0});
  EXPECT_THROW(walled<double>(particles, Wall<double>{1.}, {}), std::invalid_argument);
  EXPECT_THROW(walled<double>(particles, Wall<double>{1.5}, {}), std::invalid_argument);
  EXPECT_THROW(walled<double>(particles, {}, Wall<double>{2.}), std::invalid_argument);
  EXPECT_THROW(walled<double>(particles, Wall<double>{0., 0., 1.5}, {}), std::invalid_argument);
  EXPECT_THROW(walled<double>(particles, Wall<double>{0., NAN}, {}), std::invalid_argument);
  EXPECT_THROW(walled<double>(particles, thermal(0., -1), {}), std::invalid_argument);
  EXPECT_THROW(walled<double>(gaussian_ring(10, 10), Wall<double>{-1.}, {}), std::invalid_argument);
  EXPECT_NO_THROW(walled<double>(particles, Wall<double>{0.}, Wall<double>{3.}));
}

}  // namespace walls_test
