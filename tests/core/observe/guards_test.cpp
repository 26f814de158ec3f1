// Guards are silent in correct runs (of other kinds: engine/same_bits_test.cpp), and each guard reports an error of its
// own quantity that is far too small to be seen in a result.
#include <gtest/gtest.h>

#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/between_walls.hpp"

namespace cradle::test::guards_test {

using Dry = Inelastic<double>;

template <class Run>
GuardCheck<double> inspect(const Run& run, const Particles<double>& particles, const Configuration<double>& c) {
  return guarded(c, particles, run.counts().collisions, particles.kinetic_energy() - run.energy_lost(), c.time,
                 run.last_collision_time(), 0., true);
}

TEST(Guards, AreSilentOnAGasWithoutEvents) {
  for (const auto& particles : {uniform_rows(300), gaussian_ring(200, 200)}) {
    StickyGas<double> gas(particles, 0.);
    for (const double time : {1., 10., 100., 500.}) {
      gas.advance(time);
      EXPECT_FALSE(inspect(gas, *particles, gas.configuration(time)).broken) << time;
    }
  }
}

// Three elastic particles of different masses between walls: closing speeds cease to add up to 0 by rounding, so a wall
// moves, as it were, by d, and does the work (2 E/L) d = 2 E d/3. Without it the guard stopped such runs.
TEST(Guards, KnowTheWorkOfWallsThatRoundingMoves) {
  const auto particles =
      between(0, list<double>({1, 2, 2.7}, {1, 0, -0.3}, {1, 3, 2}), Wall<double>{0}, Wall<double>{3});
  Simulation run(Dry(1), GapChain<double, IndividualMasses<double>>(particles, 0.));
  const double energy = particles->kinetic_energy();
  for (double time = 16000; time < 600000; time *= 2) {
    run.advance(time);
    auto now = run.configuration(time);
    const auto check = inspect(run, *particles, now);
    ASSERT_FALSE(check.broken) << time << ": " << check.broken->found << " > " << check.broken->bound;
    const double gained = kinetic_energy(now, *particles) - energy, work = 2 * energy / 3 * *now.closure_gap;
    EXPECT_NEAR(gained, work, 0.01 * std::abs(work)) << time;
    for (double& v : now.v) v *= 1 + 1e-7;
    EXPECT_TRUE(inspect(run, *particles, now).broken) << time;
  }
}

// Errors planted in a configuration, and the guard that finds each.
TEST(Guards, FindAnErrorOfTheirOwnQuantity) {
  const auto particles = uniform_rows(300);
  Simulation run(Dry(0.99, 1e-3), GapChain<double>(particles, 0.));
  run.advance(200);
  const double nan = std::numeric_limits<double>::quiet_NaN(), last = run.last_collision_time();
  using Changed = Configuration<double>;
  const struct {
    const char* name;
    std::optional<Guard> guard;
    std::function<void(Changed&)> plant;
  } rows[] = {
      {"particles that have changed places", Guard::order, [](Changed& c) { c.gap[40] = -1e-6; }},
      {"a collision that is still to come", Guard::past, [=](Changed& c) { c.time = last - 1e-6; }},
      {"a time that is rounded anew from an origin that has moved", std::nullopt,
       [=](Changed& c) { c.time = std::nextafter(last, 0.); }},
      // Momentum stays: two particles that differ by 1 in velocity are brought nearer by a part in a million.
      {"energy", Guard::energy,
       [](Changed& c) {
         const double nearer = 1e-6 * (c.v[60] > c.v[30] ? -1 : 1);
         c.v[30] += nearer, c.v[60] -= nearer;
       }},
      // Energy stays: a particle that is turned round.
      {"momentum", Guard::momentum, [](Changed& c) { c.v[10] = -c.v[10]; }},
      {"closure of gaps", Guard::closure, [](Changed& c) { c.closure_gap = 1e-5; }},
      {"closure of speeds", Guard::closure, [](Changed& c) { c.closure_speed = -1e-6; }},
      {"a gap that is no number", Guard::order, [=](Changed& c) { c.gap[40] = nan; }},
      {"a velocity that is none either", Guard::energy, [=](Changed& c) { c.gap[40] = c.v[5] = nan; }},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    Configuration<double> now = run.configuration(200);
    row.plant(now);
    const auto broken = inspect(run, *particles, now).broken;
    ASSERT_EQ(broken.has_value(), row.guard.has_value());
    if (!broken) continue;
    EXPECT_EQ(broken->guard, *row.guard);
    if (broken->guard == Guard::order) {
      EXPECT_EQ(broken->particle, now.index[40]);
    }
  }
}

// Of a run in which a collision with a wall was missed.
struct Missed {
  using Scalar = double;
  double left = 1, right = 1;
  std::optional<double> gap_to_wall(End end, double) const { return end == End::left ? left : right; }
  Counts counts() const { return {}; }
};
TEST(Guards, FindAParticleBeyondAWall) {
  const auto particles = between(0, list<double>({1, 2}, {1, -1}), Wall<double>{0}, Wall<double>{3});
  EXPECT_FALSE(beyond_a_wall(Missed{1e-3, 0}, *particles, 5., 5.));
  EXPECT_FALSE(beyond_a_wall(Missed{-1e-15, -1e-15}, *particles, 5., 5.)) << "by rounding";
  const auto on_left = beyond_a_wall(Missed{-1e-11, 1}, *particles, 5., 5.),
             on_right = beyond_a_wall(Missed{1, -1e-11}, *particles, 5., 5.);
  ASSERT_TRUE(on_left && on_right);
  EXPECT_EQ(on_left->guard, Guard::wall);
  EXPECT_EQ(on_left->particle, 0);
  EXPECT_EQ(on_right->particle, 1);
}

}  // namespace cradle::test::guards_test
