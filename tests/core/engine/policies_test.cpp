// Collapse policies that change the law: the contact-time model (Luding and McNamara 1998, doi 10.1007/s100350050017),
// in which a collision is elastic if one of its particles had another one less than t_c before, and merging below a
// closing speed.

#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::policies_test {

TEST(ContactTime, OnlyRestedParticlesDissipate) {
  // Collisions of the plain law at t = 1, then ever faster: with t_c above all later intervals only the first
  // dissipates, mu w^2 (1 - eps^2)/2 = (1/2)(1)(1 - 1/400)/2, since the second has a particle of the first.
  Simulation run(ContactTime(Inelastic(0.05), 10.0), GapChain<double>(three_particles(), 0.0));
  EXPECT_EQ(run.advance(100.0), Status::reached);
  EXPECT_NEAR(run.energy_lost(), (1 - 0.0025) / 4, 1e-16);
  EXPECT_EQ(run.counts().below_cutoff, run.counts().collisions - 1);
}

TEST(ContactTime, ShorterThanEveryIntervalItIsThePlainLaw) {
  Simulation plain(Inelastic(0.9), GapChain<double>(uniform_rows(200), 0.0));
  Simulation timed(ContactTime(Inelastic(0.9), 1e-300), GapChain<double>(uniform_rows(200), 0.0));
  plain.advance(40.0);
  timed.advance(40.0);
  EXPECT_EQ(plain.counts().collisions, timed.counts().collisions);
  EXPECT_EQ(plain.energy_lost(), timed.energy_lost());
  EXPECT_EQ(timed.counts().below_cutoff, 0U);
}

TEST(ContactTime, BothRepresentationsAgree) {
  const ContactTime law(Inelastic(0.9), 1e-3);
  Simulation gaps(law, GapChain<double>(uniform_rows(400), 0.0));
  Simulation positions(law, PositionChain<double>(uniform_rows(400), 0.0));
  for (const double t : {20.0, 60.0, 80.0}) {
    gaps.advance(t);
    positions.advance(t);
    EXPECT_EQ(gaps.counts().collisions, positions.counts().collisions);
    EXPECT_EQ(gaps.counts().below_cutoff, positions.counts().below_cutoff);
  }
  EXPECT_GT(gaps.counts().below_cutoff, 0U);
  EXPECT_LT(gaps.counts().below_cutoff, gaps.counts().collisions);
}

TEST(Merging, CollapseEndsInOneParticle) {
  Simulation run(InelasticMerging(Inelastic(0.05), 1e-3), ClusterChain<double>(three_particles(), 0.0));
  EXPECT_EQ(run.advance(100.0), Status::reached);
  EXPECT_EQ(run.counts().merges, 2U);
  const auto end = configuration_at(run, 100.0);
  ASSERT_EQ(end.x.size(), 1U);
  EXPECT_EQ(end.m[0], 3.0);
  // The momentum is 0: the centre of mass rests at 4/3, all energy (1) is lost. A unit of rounding per collision,
  // some 12.
  EXPECT_NEAR(end.v[0], 0.0, 1e-15);
  EXPECT_NEAR(end.x[0], 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(run.energy_lost(), 1.0, 1e-15);
}

TEST(Merging, NeverReachedItIsThePlainLaw) {
  Simulation clusters(InelasticMerging(Inelastic(0.999), 0.0), ClusterChain<double>(uniform_rows(400), 0.0));
  Simulation gaps(Inelastic(0.999), GapChain<double>(uniform_rows(400), 0.0));
  for (const double t : {50.0, 150.0, 250.0}) {
    clusters.advance(t);
    gaps.advance(t);
    EXPECT_EQ(clusters.counts().collisions, gaps.counts().collisions);
    EXPECT_NEAR(clusters.energy_lost(), gaps.energy_lost(), 1e-12 * gaps.energy_lost());
  }
  EXPECT_EQ(clusters.counts().merges, 0U);
}

TEST(Merging, TheLedgerHolds) {
  const auto particles = uniform_rows(400);
  Simulation run(InelasticMerging(Inelastic(0.9), 1e-3), ClusterChain<double>(particles, 0.0));
  for (const double t : {50.0, 90.0, 150.0, 400.0}) {
    run.advance(t);
    const auto now = configuration_at(run, t);
    const double left = particles->kinetic_energy() - run.energy_lost();
    EXPECT_NEAR(kinetic_energy(now, *particles), left, 1e-13 * particles->kinetic_energy());
    EXPECT_NEAR(momentum_gained(now, *particles), 0.0, 1e-12);
  }
  EXPECT_GT(run.counts().merges, 0U);
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

}  // namespace cradle::test::policies_test
