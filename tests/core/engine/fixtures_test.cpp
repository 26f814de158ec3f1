// Runs of the inelastic and the wet gas whose collision counts an independent event-driven N-particle program gives
// identically in double, binary128 and 100 digits; energies are from the wider ones. Proves: both representations make
// exactly those collisions, and lose exactly that energy.
//
// Tolerance of the energy. The sequence of collisions alone decides velocities, and a collision cannot amplify an error
// of them (it does not increase the energy norm), so each adds a rounding of u w (u = 1.1e-16, w the closing speed).
// With sum w^2 = 4 loss/(1-eps^2) the errors, as a random walk, reach u sqrt(1.5e6) = 1.3e-13 in the longest run and
// hence at most sqrt(2E) 1.3e-13 = 3e-12 of E = 263. The decimal 0.999 read as double moves 1-eps by 5e-14 of itself
// and the energy by 5e-14 loss/E < 2e-13 of itself: the sum is below 1e-12 relative for all.
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::fixtures_test {

struct Row {
  double time;
  std::uint64_t collisions, below_cutoff_or_merges;
  double energy;
};

template <class Run>
void expect_rows(const char* chain, Run run, const Scene<double>& particles, const std::vector<Row>& rows) {
  SCOPED_TRACE(chain);
  for (const Row& row : rows) {
    ASSERT_EQ(run.advance(row.time), Status::reached);
    EXPECT_EQ(run.counts().collisions, row.collisions) << "t = " << row.time;
    EXPECT_EQ(run.counts().below_cutoff + run.counts().merges, row.below_cutoff_or_merges) << "t = " << row.time;
    EXPECT_NEAR(particles->kinetic_energy() - run.energy_lost(), row.energy, 1e-12 * row.energy) << "t = " << row.time;
    EXPECT_NEAR(kinetic_energy(configuration_at(run, row.time), *particles), row.energy, 1e-12 * row.energy)
        << "direct sum, t = " << row.time;
  }
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

void expect_in_both_chains(const Scene<double>& particles, const Inelastic<double>& law, const std::vector<Row>& rows) {
  expect_rows("gaps", gap_run(particles, law), particles, rows);
  expect_rows("positions", position_run(particles, law), particles, rows);
}

TEST(Fixtures, MixedVelocities) {
  expect_in_both_chains(
      rmix<double>(32), Inelastic(0.9375, 0.),
      {{1, 5, 0, 6.63748402689816430211}, {10, 66, 0, 4.69922643744171297629}, {1000, 188, 0, 4.09494449933385114261}});
}

TEST(Fixtures, ShockWithMostCollisionsBelowTheCutoff) {
  expect_in_both_chains(rshock<double>(200), Inelastic(0.9, 1e-3),
                        {{20, 129, 0, 22.3629699142628695777},
                         {50, 933, 0, 18.8195198282875660365},
                         {100, 430496, 344471, 12.5000032613865101}});
}

TEST(Fixtures, ShockOfThePapersFigure2) {
  expect_in_both_chains(rshock<double>(8000), Inelastic(0.999, 1e-5),
                        {{999.5, 384155, 0, 887.274363235560075},
                         {1999, 1299216, 0, 738.145120941488556},
                         {4000, 4685816, 0, 492.025770085541422},
                         {6000, 16156905, 0, 262.948286528987387}});
}

void expect_wet_rows(ParticleIndex count, double loss, const std::vector<Row>& rows) {
  const auto particles = rshock<double>(count);
  expect_rows("clusters", Simulation(Wet<double>{loss}, ClusterChain<double>{particles, 0.0}), particles, rows);
}

TEST(Fixtures, WetShockUntilTheRowsAreUsedUpAndAfter) {
  expect_wet_rows(200, 0.01,
                  {{20, 171, 0, 23.29},
                   {55, 851, 11, 16.5082234265726200},
                   {100, 1169, 84, 13.7984254962899249},
                   {150, 1911, 127, 6.64337178827478268},
                   {250, 2545, 191, .666296741488632748},
                   {400, 2546, 192, .665686071625090766}});
}

TEST(Fixtures, WetShockOfThePapersFigure6) {
  expect_wet_rows(50000, 1e-4,
                  {{2000, 1724590, 0, 6077.541},
                   {4999, 7682229, 0, 5481.7771},
                   {6000, 8897750, 1918, 5360.32405660858910},
                   {9000, 9477159, 8139, 5302.85558842691832},
                   {12000, 12153997, 9771, 5035.27051471133100}});
}

TEST(Fixtures, WetShockOfThePapersFigure11HoldsOnlyTheActiveZone) {
  expect_wet_rows(20000000, 0.05,
                  {{1e5, 299358, 99994, 2487499.86929305}, {1e6, 2999594, 999992, 2375000.15424516508}});
}

}  // namespace cradle::test::fixtures_test
