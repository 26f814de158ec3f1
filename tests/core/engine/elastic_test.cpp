// The elastic gas (eps = 1): equal particles exchange velocities, so tracers pass through each other freely and
// everything is known at any time: positions are sort(x_i + v_i t), velocities go with them, the collisions made are
// the inversions of x_i + v_i t. Proves: counts and velocities exact in double (velocities of these fixtures are sums
// of exact numbers), positions to rounding. (In rational arithmetic: precision/exact_gas_test.cpp. Lattices, and all
// particles at one point: precision/extremes_test.cpp.)
#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace cradle::test::elastic_test
