// The engine in exact rational arithmetic, where every identity holds with ==. Proves: rows that are streamed and rows
// that are held are the same dynamics as absolute positions; collapse obeys its closed forms; and observers require
// nothing of a scalar that a rational lacks. (Every law against an exact gas, and double against both:
// precision/exact_gas_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace cradle::test::rational_test {

struct Collisions {
  std::vector<ParticleIndex> left;
  std::vector<Rational> time;
  void operator()(const Collision<Rational>& collision) {
    left.push_back(collision.left);
    time.push_back(collision.time.value());
  }
};

template <class Gaps>
void expect_the_same_dynamics(Gaps gaps, PositionRun<Rational> positions, const Rational& end, const char* name) {
  SCOPED_TRACE(name);
  Collisions in_gaps, in_positions;
  gaps.advance(end, in_gaps);
  positions.advance(end, in_positions);
  EXPECT_EQ(in_gaps.left, in_positions.left);
  EXPECT_EQ(in_gaps.time, in_positions.time);
  const auto a = configuration_at(gaps, end), b = configuration_at(positions, end);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.gap, b.gap);
  EXPECT_EQ(a.closing_speed, b.closing_speed);
  EXPECT_EQ(gaps.energy_lost(), positions.energy_lost());
}

TEST(Rational, StreamedRowsAndHeldOnesAreTheSameDynamics) {
  const auto rows = rshock<Rational>(12);
  const Inelastic<Rational> soft(Rational(15) / Rational(16), Rational(0));
  for (int t = 2; t <= 20; ++t) {  // from the first collision on: before it a streamed chain shows what it holds
    expect_the_same_dynamics(gap_run(rows, soft), position_run(rows, soft), t, "streamed");
    expect_the_same_dynamics(gap_run(rows, soft, {}, Rational(0), {.hold_all = true}), position_run(rows, soft), t,
                             "held");
  }
}

// Three particles at eps = 1/20, where lam+ = 2/5, lam- = 1/8 and t_c = 12/7 are rational: every collision lies on the
// closed form, g_n p_n = eps^n and t_c - t_n = g_n/(p_{n+1} - lam- p_n).
TEST(Rational, CollapseObeysItsClosedForm) {
  const Rational eps(1, 20), a = (1 + eps) / 2, slow(1, 8), collapse(12, 7);
  SlowLoop loop(Inelastic<Rational>(eps), GapChain<Rational>(three_particles<Rational>(), 0));
  Rational invariant = 1, before = 0;
  for (int n = 0; n < 40; ++n) {
    const auto s = loop.next();
    ASSERT_TRUE(s.has_value());
    const auto step = loop.collide(*s);
    const Rational p = step.closing_speed, g = step.nearest_gap;
    EXPECT_EQ(g * p, invariant) << n;
    const Rational next = n == 0 ? Rational(1 + a) : Rational(a * p - eps * before);
    EXPECT_EQ(collapse - step.time.value(), g / (next - slow * p)) << n;
    before = p;
    invariant *= eps;
  }
}

TEST(Rational, ObserversTakeRationals) {
  const auto particles = rmix<Rational>(12);
  auto run = gap_run(particles, Inelastic<Rational>(Rational(15, 16)));
  run.advance(Rational(10));
  const auto state = configuration_at(run, Rational(10));
  EXPECT_EQ(sample(run, particles->kinetic_energy(), Rational(10)).energy, kinetic_energy(state, *particles));
  EXPECT_GT(gap_statistics(state).median, 0);
  const Profile p = profile(state, *particles, Rational(10), {-100, 100}, 1);
  EXPECT_EQ(p.density[0] * 200, 12);
}

}  // namespace cradle::test::rational_test
