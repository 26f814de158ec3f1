// The engine in exact rational arithmetic, where every identity holds with ==, as oracle of the engine in double.
// Proves: momentum, energy = ledger and closure exactly; gaps and absolute positions are the same dynamics exactly;
// collapse obeys its closed forms exactly; double makes the same collisions in the same order and is off by rounding
// only (bounds as derived in properties_test.cpp); and the engine requires nothing of a scalar that a rational lacks.
#include <gtest/gtest.h>

#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/slow_loop.hpp"

namespace cradle::test::rational_test {

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

struct Case {
  const char* name;
  int particles, numerator, denominator;  // restitution
  bool equal_masses;
  int end;
};
const Case cases[] = {{"eps = 15/16", 12, 15, 16, true, 40},
                      {"eps = 1", 10, 1, 1, true, 40},
                      {"eps = 1/3", 9, 1, 3, true, 40},
                      {"eps = 3/4, unequal masses", 12, 3, 4, false, 40}};

template <class T> Scene<T> scene(const Case& c) {
  return as_list(*rmix<T>(c.particles),
                 [&](ParticleIndex b) { return c.equal_masses ? T(1) : T(1 + bits_of(b, 40, 7)); });
}
template <class T> Inelastic<T> law(const Case& c) { return Inelastic<T>(T(c.numerator) / T(c.denominator)); }

template <class T> struct Collisions {
  std::vector<ParticleIndex> left;
  std::vector<T> time;
  void operator()(const Collision<T>& collision) {
    left.push_back(collision.left);
    time.push_back(collision.time.value());
  }
};

TEST(Rational, MomentumEnergyAndClosureAreExact) {
  for (const Case& c : cases) {
    const auto particles = scene<Rational>(c);
    auto run = mass_run(particles, law<Rational>(c));
    for (int t = 1; t <= c.end; t += 3) {
      ASSERT_EQ(run.advance(Rational(t)), Status::reached);
      const auto state = configuration_at(run, Rational(t));
      ASSERT_EQ(momentum_gained(state, *particles), 0) << c.name;
      ASSERT_EQ(kinetic_energy(state, *particles), particles->kinetic_energy() - run.energy_lost()) << c.name;
      ASSERT_EQ(state.closure_gap, 0);
      ASSERT_EQ(state.closure_speed, 0);
      for (const Rational& gap : state.gap) ASSERT_GE(gap, 0);
    }
    EXPECT_GT(run.counts().collisions, 12U) << c.name;
    EXPECT_EQ(run.chain().account().order_lost + run.chain().account().simultaneous, 0U);
  }
}

template <class Gaps>
void expect_the_same_dynamics(Gaps gaps, PositionRun<Rational> positions, const Rational& end, const char* name) {
  SCOPED_TRACE(name);
  Collisions<Rational> in_gaps, in_positions;
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

TEST(Rational, GapsAndPositionsAreTheSameDynamics) {
  for (const Case& c : cases) {
    const auto particles = scene<Rational>(c);
    expect_the_same_dynamics(mass_run(particles, law<Rational>(c)), position_run(particles, law<Rational>(c)), c.end,
                             c.name);
  }
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

// Between collisions nothing amplifies an error; at them, see properties_test.cpp. The restitution 1/3 in double is off
// by less than a rounding, which counts once more a collision.
TEST(Rational, DoubleMakesTheSameCollisions) {
  for (const Case& c : cases) {
    auto exact = mass_run(scene<Rational>(c), law<Rational>(c));
    auto rounded = mass_run(scene<double>(c), law<double>(c));
    Collisions<Rational> exact_collisions;
    Collisions<double> rounded_collisions;
    exact.advance(Rational(c.end), exact_collisions);
    rounded.advance(c.end, rounded_collisions);
    ASSERT_EQ(exact_collisions.left, rounded_collisions.left) << c.name;

    const auto n = static_cast<double>(exact_collisions.left.size());
    const double velocity = 3 * n * 2 * u, place = (3 * n + 4) * 2 * c.end * u + velocity * c.end;
    const auto a = configuration_at(exact, Rational(c.end));
    const auto b = configuration_at(rounded, static_cast<double>(c.end));
    for (std::size_t j = 0; j < a.x.size(); ++j) {
      EXPECT_NEAR(to_double(Rational(a.x[j] - exactly(b.x[j]))), 0, place) << c.name;
      EXPECT_NEAR(to_double(Rational(a.v[j] - exactly(b.v[j]))), 0, velocity) << c.name;
    }
    for (std::size_t j = 0; j + 1 < a.x.size(); ++j)
      EXPECT_NEAR(to_double(Rational(a.gap[j] - exactly(b.gap[j]))), 0, place) << c.name;
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
  const auto particles = scene<Rational>(cases[0]);
  auto run = gap_run(particles, law<Rational>(cases[0]));
  run.advance(Rational(10));
  const auto state = configuration_at(run, Rational(10));
  EXPECT_EQ(sample(run, particles->kinetic_energy(), Rational(10)).energy, kinetic_energy(state, *particles));
  EXPECT_GT(gap_statistics(state).median, 0);
  const Profile p = profile(state, *particles, Rational(10), {-100, 100}, 1);
  EXPECT_EQ(p.density[0] * 200, 12);
}

}  // namespace cradle::test::rational_test
