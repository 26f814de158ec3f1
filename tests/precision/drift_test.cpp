// What rounding does to a long run in double. Proves: after 1e7 collisions (1e8 in the slow test) momentum, the sum of
// all closing speeds and the balance of energy are off by what a random walk of roundings gives, and by no more.
//
// Bound. A collision rounds three closing speeds, by u of the largest at most, u = 2^-53. They differ from collision to
// collision, so errors add up in squares: 3 sum w^2 u^2, and the ledger knows sum w^2 = 4 lost/(1 - eps^2) for
// collisions of unit masses that lose energy. Neighbours' closing speeds are like the pair's own: allow twice that, and
// six standard deviations. A particle's velocity is off by as much; momentum by the number of particles times it,
// energy by sqrt(2 E N) times it at most.
#include <gtest/gtest.h>

#include <cmath>

#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace drift_test {

using namespace cradle;
using namespace cradle::test;

void expect_no_drift(double end, std::uint64_t least_collisions) {
  const double restitution = 0.999, u = 0x1p-53;
  const auto particles = rshock<double>(8000);
  auto run = gap_run(particles, Inelastic<double>(restitution, 1e-5));
  ASSERT_EQ(run.advance(end), Status::reached);
  EXPECT_GE(run.counts().collisions, least_collisions);
  const auto c = configuration_at(run, end);
  const auto n = static_cast<double>(c.x.size());
  const double sum_of_squares = 4 * run.energy_lost() / ((1 - restitution) * (1 + restitution));
  const double speed_error = 6 * u * std::sqrt(2 * 3 * sum_of_squares);
  EXPECT_LE(std::abs(c.closure_speed.value()), speed_error);
  EXPECT_LE(std::abs(momentum_gained(c, *particles)), n * speed_error);
  const double direct = kinetic_energy(c, *particles, c.time), ledger = particles->kinetic_energy() - run.energy_lost();
  EXPECT_LE(std::abs(direct - ledger), std::sqrt(2 * direct * n) * speed_error);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

TEST(Drift, StaysARandomWalkForTenMillionCollisions) { expect_no_drift(6000, 10000000); }
TEST(SlowDrift, StaysARandomWalkForAHundredMillionCollisions) { expect_no_drift(6550, 100000000); }

}  // namespace drift_test
