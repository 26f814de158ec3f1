// The whole engine on a scalar without implicit conversions (strict_real.hpp). Proves: core/ uses the scalar only
// through the concept Real; the general code, written for types whose queue keys are rounded times, makes the same
// collisions as the code for double and gives the same bits; observers require nothing of a scalar that a rational
// lacks.
#include <gtest/gtest.h>

#include <cmath>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/strict_real.hpp"

namespace cradle::test::strict_scalar_test {

static_assert(Real<StrictReal>);
static_assert(!std::convertible_to<double, StrictReal> && !std::convertible_to<int, StrictReal>);
static_assert(!std::convertible_to<StrictReal, double> && !std::default_initializable<StrictReal>);

// All that a configuration holds.
template <class T> std::vector<double> numbers(const Configuration<T>& c) {
  std::vector<double> all{to_double(c.time)};
  for (const auto place : {c.from, c.to, ParticleIndex(c.collided_from), ParticleIndex(c.collided_to)})
    all.push_back(double(place));
  for (const ParticleIndex particle : c.index) all.push_back(double(particle));
  for (const auto* list : {&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}) {
    all.push_back(double(list->size()));
    for (const T& x : *list) all.push_back(to_double(x));
  }
  for (const auto* error : {&c.closure_gap, &c.closure_speed}) all.push_back(*error ? to_double(**error) : INFINITY);
  return all;
}

template <class T> Inelastic<T> law() { return Inelastic<T>(number<T>(0.9), number<T>(1e-3)); }

// make(T) gives the same run in the scalar T.
template <class Make> void expect_the_bits_of_double(Make make, const std::vector<double>& times) {
  auto strict = make(StrictReal(0));
  auto plain = make(0.);
  for (const double t : times) {
    const Status status = plain.advance(t);
    ASSERT_EQ(strict.advance(number<StrictReal>(t)), status) << "t = " << t;
    ASSERT_TRUE(same_collisions(strict.counts(), plain.counts())) << "t = " << t;
    ASSERT_EQ(strict.counts().origin_moves, plain.counts().origin_moves) << "t = " << t;
    ASSERT_EQ(numbers(configuration_at(strict, number<StrictReal>(t))), numbers(configuration_at(plain, t)))
        << "t = " << t;
    // In double the ledger is compensated, in unknown types it is a plain sum of positive terms.
    ASSERT_NEAR(to_double(strict.energy_lost()), plain.energy_lost(),
                static_cast<double>(plain.counts().collisions) * std::numeric_limits<double>::epsilon() *
                    plain.energy_lost())
        << "t = " << t;
  }
}

TEST(StrictScalar, GapsOfIdenticalParticles) {
  expect_the_bits_of_double([]<class T>(T) { return gap_run(rshock<T>(200), law<T>()); }, {.5, 20, 50, 62, 70, 100});
  expect_the_bits_of_double([]<class T>(T) { return gap_run(rmix<T>(100), law<T>()); }, {1, 10, 100, 1000});
}

TEST(StrictScalar, GapsOfUnequalMasses) {
  expect_the_bits_of_double([]<class T>(T) { return mass_run(unequal_rows<T>(), law<T>()); }, {.5, 20, 50});
}

TEST(StrictScalar, Positions) {
  expect_the_bits_of_double([]<class T>(T) { return position_run(unequal_rows<T>(), law<T>()); }, {.5, 20, 50});
}

TEST(StrictScalar, ClustersOfWetAndStickyParticles) {
  expect_the_bits_of_double(
      []<class T>(T) { return Simulation(Wet<T>(number<T>(0.01)), ClusterChain<T>(rshock<T>(200), T(0))); },
      {.5, 20, 55, 100});
  expect_the_bits_of_double(
      []<class T>(T) { return Simulation(Sticky<T>(), ClusterChain<T>(unequal_rows<T>(), T(0))); }, {.5, 20, 50});
  expect_the_bits_of_double(
      []<class T>(T) {
        return Simulation(InelasticMerging<T>(law<T>(), number<T>(1e-2)), ClusterChain<T>(rmix<T>(100), T(0)));
      },
      {1, 10, 100});
}

TEST(StrictScalar, CollapsePolicies) {
  const auto collapse = []<class T>(T zero) {
    auto run = gap_run<T>(list<T>({T(0), T(1), T(3)}, {T(1), zero, T(-1)}), Inelastic<T>(number<T>(0.05)),
                          {CollapsePolicy::stop, zero, {}});
    EXPECT_EQ(run.advance(T(100)), Status::collapsed);
    return std::pair(to_double(run.collapse().time.value()), run.counts().collisions);
  };
  EXPECT_EQ(collapse(StrictReal(0)), collapse(0.));
}

TEST(StrictScalar, Observers) {
  const auto observe = []<class T>(T zero) {
    const auto particles = rshock<T>(100);
    auto run = gap_run(particles, law<T>());
    std::vector<double> seen;
    run.advance(T(20), [&](const Collision<T>& c) {
      seen.push_back(to_double(c.interval));
      seen.push_back(to_double(c.closing_speed));
    });
    const auto c = configuration_at(run, T(20));
    const auto s = sample(run, particles->kinetic_energy(), T(20));
    const auto p = profile(c, *particles, T(20), {-20, 20}, 10);
    for (const auto& values : {p.density, p.velocity, p.temperature})
      seen.insert(seen.end(), values.begin(), values.end());
    for (const T& value : {*s.front_left, *s.front_right, gap_statistics(c).least, gap_statistics(c).median,
                           kinetic_energy(c, *particles), momentum_gained(c, *particles), zero})
      seen.push_back(to_double(value));
    return seen;
  };
  EXPECT_EQ(observe(StrictReal(0)), observe(0.));
}

// Nor do they require what rationals lack.
TEST(StrictScalar, ObserversTakeRationals) {
  const auto particles = rmix<Rational>(12);
  auto run = gap_run(particles, Inelastic<Rational>(Rational(15, 16)));
  run.advance(Rational(10));
  const auto state = configuration_at(run, Rational(10));
  EXPECT_EQ(sample(run, particles->kinetic_energy(), Rational(10)).energy, kinetic_energy(state, *particles));
  EXPECT_GT(gap_statistics(state).median, 0);
  const Profile p = profile(state, *particles, Rational(10), {-100, 100}, 1);
  EXPECT_EQ(p.density[0] * 200, 12);
}

}  // namespace cradle::test::strict_scalar_test
