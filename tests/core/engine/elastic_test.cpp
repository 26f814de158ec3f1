// The elastic gas (eps = 1): equal particles exchange velocities, so tracers pass through each other freely and
// everything is known at any time: positions are sort(x_i + v_i t), velocities go with them, the collisions made are
// the inversions of x_i + v_i t. Proves: counts and velocities exact in double (velocities of these fixtures are sums
// of exact numbers), positions to rounding. (In rational arithmetic: precision/exact_gas_test.cpp.)
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::elastic_test {

struct Free {
  std::vector<double> x, v;  // tracers at time t, sorted by place
  std::uint64_t inversions = 0;
};

Free free_flight(const Particles<double>& particles, double t) {
  const auto n = static_cast<std::size_t>(particles.count());
  std::vector<std::pair<double, double>> tracers;
  for (ParticleIndex b = 0; b < particles.count(); ++b)
    tracers.emplace_back(particles.position(b) + particles.velocity(b) * t, particles.velocity(b));
  Free free;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) free.inversions += !(tracers[i].first < tracers[j].first);
  // Tracers at the same place have just met: the slower one is on the left from here on.
  std::sort(tracers.begin(), tracers.end());
  for (const auto& [x, v] : tracers) {
    free.x.push_back(x);
    free.v.push_back(v);
  }
  return free;
}

// A collision is timed to 2^-53 of the time since the origin moved last, at most t, and moves by it what is closing at
// 2 at most; places are rounded likewise. With up to 200 collisions a particle and four such roundings each: 800 t
// 2^-53.
double tolerance(double t) { return 800 * std::max(t, 200.) * std::numeric_limits<double>::epsilon(); }

template <class Run>
void expect_free_flight(Run run, const Particles<double>& particles, const std::vector<double>& times) {
  for (const double t : times) {
    SCOPED_TRACE(t);
    ASSERT_EQ(run.advance(t), Status::reached);
    const auto free = free_flight(particles, t);
    ASSERT_EQ(run.counts().collisions, free.inversions);
    EXPECT_EQ(run.energy_lost(), 0);
    const auto c = configuration_at(run, t);
    for (std::size_t j = 0; j < c.x.size(); ++j) {
      const auto particle = static_cast<std::size_t>(c.index[j]);
      ASSERT_NEAR(c.x[j], free.x[particle], tolerance(t)) << "particle " << particle;
      ASSERT_EQ(c.v[j], free.v[particle]) << "particle " << particle;
    }
  }
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

TEST(Elastic, MixedVelocitiesSortThemselves) {
  const auto particles = rmix<double>(200);
  const Inelastic<double> law(1, 0);
  expect_free_flight(gap_run(particles, law), *particles, {1, 5, 20, 100, 1000, 1e5});
  expect_free_flight(mass_run(particles, law), *particles, {1, 5, 20, 100, 1000, 1e5});
  expect_free_flight(position_run(particles, law), *particles, {1, 5, 20, 100, 1000});
}

TEST(Elastic, PerturbedRowsPassThroughEachOther) {
  const auto particles = rshock<double>(300);
  expect_free_flight(gap_run(particles, Inelastic(1.)), *particles, {.5, 1, 7.25, 50, 140, 300});
  expect_free_flight(position_run(particles, Inelastic(1.)), *particles, {.5, 1, 7.25, 50, 140, 300});
}

// Rows on a lattice: at every multiple of l/(2 u0) one more layer meets. Collisions at such a time count as made.
TEST(Elastic, LatticeRowsMakeTriangularNumbersOfCollisions) {
  const auto particles = lattice_rows(400);
  const auto expect_triangular = [](auto run) {
    for (std::uint64_t layers = 1; layers <= 200; ++layers) {
      run.advance(static_cast<double>(layers) - 0.5);
      ASSERT_EQ(run.counts().collisions, layers * (layers - 1) / 2);
      run.advance(static_cast<double>(layers));
      ASSERT_EQ(run.counts().collisions, layers * (layers + 1) / 2);
    }
    run.advance(1000);
    EXPECT_EQ(run.counts().collisions, 200U * 200U) << "every tracer has met every one of the other row";
    EXPECT_EQ(run.chain().account().order_lost, 0U);
    EXPECT_EQ(run.chain().account().simultaneous, 0U) << "gaps between those that close are open";
  };
  expect_triangular(gap_run<double>(particles, Inelastic(1.)));
  expect_triangular(gap_run<double>(particles, Inelastic(1.), {}, 0, {.hold_all = true}));
  expect_triangular(position_run<double>(particles, Inelastic(1.)));
}

// x_i = i, v_i = -i: all are at 0 at t = 1, in exact numbers. The tie rule makes some order of the n(n - 1)/2
// collisions, and velocities come out sorted, whichever.
TEST(Elastic, AllParticlesMeetAtOnePoint) {
  const auto expect_sorted = [](auto run, ParticleIndex n) {
    ASSERT_EQ(run.advance(2), Status::reached);
    EXPECT_EQ(run.counts().collisions, static_cast<std::uint64_t>(n * (n - 1) / 2));
    EXPECT_GT(run.chain().account().simultaneous, 0U);
    EXPECT_EQ(run.chain().account().order_lost, 0U);
    const auto c = configuration_at(run, 2.);
    for (ParticleIndex b = 0; b < n; ++b) {
      const auto j = static_cast<std::size_t>(b);
      ASSERT_EQ(c.v[j], static_cast<double>(b + 1 - n)) << b;
      ASSERT_EQ(c.x[j], c.v[j]) << b;
    }
  };
  for (const ParticleIndex n : {3, 4, 10, 61}) {
    std::vector<double> x(static_cast<std::size_t>(n)), v(x.size());
    std::iota(x.begin(), x.end(), 0);
    std::transform(x.begin(), x.end(), v.begin(), [](double place) { return -place; });
    expect_sorted(gap_run<double>(list(x, v), Inelastic(1.)), n);
    expect_sorted(position_run<double>(list(x, v), Inelastic(1.)), n);
  }
}

}  // namespace cradle::test::elastic_test
