// The sticky gas without events: rows taken in as they are hit, as by the event-driven one; interruptions; its law of
// cooling. (In random scenes on lines and rings against an exact gas, in rationals and in double, ties and merges of
// everything at one time among them: precision/exact_gas_test.cpp. The cluster between rows:
// theory/sticky_shock_test.cpp.)
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::sticky_gas_test {

TEST(StickyGas, TakesInOnlyWhatIsHit) {
  int calls = 0;
  const auto counted = [&](ParticleIndex particle) { return ++calls, rshock_displacement(particle); };
  const auto rows = displaced_rows(20'000'000, counted);
  StickyGas<double> gas(rows, 0.0);
  for (const double t : {10.0, 49.9, 50.1}) gas.advance(t);
  EXPECT_LE(calls, 56);
  Simulation run(Sticky<double>{}, ClusterChain<double>(rows, 0.0));
  run.advance(50.1);
  EXPECT_EQ(gas.counts().merges, run.counts().merges);
  const auto a = gas.configuration(50.1), b = run.configuration(50.1);
  EXPECT_EQ(a.m, b.m);
  EXPECT_LE(largest_difference(a.x, b.x), 1e-12);
  EXPECT_LE(largest_difference(a.v, b.v), 1e-12);
  EXPECT_NEAR(gas.front_left(50.1), run.front_left(50.1), 1e-12);
  EXPECT_EQ(gas.collided_particles(), run.collided_particles());
}

// Interrupted again and again while rows are taken in, it ends in the bits of a gas that was left alone.
TEST(StickyGas, InterruptedItContinuesToTheSameBits) {
  const auto rows = rshock<double>(400'000);
  int calls = 0;
  const Policy<double> policy{.interrupt = [&] { return ++calls % 3 != 0; }};
  StickyGas<double> alone(rows, 0.0), interrupted(rows, 0.0, policy);
  for (const double t : {1e5, 3e5}) {
    alone.advance(t);
    int times = 0;
    for (; interrupted.advance(t) == Status::interrupted; ++times) {
      StickyGas<double> loaded(rows, 0.0, policy);
      restore(loaded, interrupted);
      interrupted = std::move(loaded);
    }
    EXPECT_GE(times, 2);
    EXPECT_EQ(SavedState::of(interrupted), SavedState::of(alone));
  }
}

// Two particles of a row, 2^-30 apart, at t = 1e9: rounding of their places is 1e-7, yet they never meet.
TEST(StickyGas, EqualVelocitiesNeverMeet) {
  StickyGas<double> gas(list<double>({1, 1 + 0x1p-30}, {0.7, 0.7}), 0.0);
  gas.advance(1e9);
  EXPECT_EQ(gas.counts().merges, 0U);
}

// E/N -> 0.221376226650747359 s^{4/3} t^{-2/3} (an independent oracle: ratios 1.0010 and 1.0037 at t = 10 and 1000 for
// 2e7 particles). At N = 1e6 and t = 100 the energy is that of some 5e4 clusters, of about its own size each: 1 %.
TEST(StickyGas, CoolsByTheTwoThirdsLaw) {
  constexpr ParticleIndex n = 1'000'000;
  const auto ring = gaussian_ring(n, double(n), 1, 0);
  StickyGas<double> gas(ring, 0.0);
  for (const double t : {10.0, 30.0, 100.0}) {
    gas.advance(t);
    const double energy = (ring->kinetic_energy() - gas.energy_lost()) / n;
    EXPECT_NEAR(energy / (0.221376226650747359 * std::pow(t, -2.0 / 3)), 1, 0.01) << t;
  }
}

}  // namespace cradle::test::sticky_gas_test
