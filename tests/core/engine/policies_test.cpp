// Collapse policies that change the law: the contact-time model (Luding and McNamara 1998, doi 10.1007/s100350050017),
// in which a collision is elastic if one of its particles had another one less than t_c before, and merging below a
// closing speed.

#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/chains/gap_chain.hpp"
#include "cradle/core/chains/position_chain.hpp"
#include "cradle/core/engine/simulation.hpp"
#include "cradle/core/initial/list.hpp"
#include "cradle/core/initial/rows.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"

namespace cradle {
namespace policies_test {

std::shared_ptr<const Particles<double>> shock(ParticleIndex particles) {
  return std::make_shared<Rows<double>>(symmetric_rows(particles, 0.5, 1.0, uniform_displacement(0.05, 3, 0)));
}

std::shared_ptr<const Particles<double>> three_particles() {
  return std::make_shared<List<double>>(std::vector<double>{0, 1, 3}, std::vector<double>{1, 0, -1});
}

TEST(ContactTime, OnlyRestedParticlesDissipate) {
  // Collisions of the plain law at t = 1, then ever faster: with t_c above all later intervals only the first
  // dissipates, mu w^2 (1 - eps^2)/2 = (1/2)(1)(1 - 1/400)/2, since the second has a particle of the first.
  Simulation run(ContactTime(Inelastic(0.05), 10.0), GapChain<double>(three_particles(), 0.0));
  EXPECT_EQ(run.advance(100.0), Status::reached);
  EXPECT_NEAR(run.energy_lost(), (1 - 0.0025) / 4, 1e-16);
  EXPECT_EQ(run.counts().below_cutoff, run.counts().collisions - 1);
}

TEST(ContactTime, ShorterThanEveryIntervalItIsThePlainLaw) {
  Simulation plain(Inelastic(0.9), GapChain<double>(shock(200), 0.0));
  Simulation timed(ContactTime(Inelastic(0.9), 1e-300), GapChain<double>(shock(200), 0.0));
  plain.advance(40.0);
  timed.advance(40.0);
  EXPECT_EQ(plain.counts().collisions, timed.counts().collisions);
  EXPECT_EQ(plain.energy_lost(), timed.energy_lost());
  EXPECT_EQ(timed.counts().below_cutoff, 0U);
}

TEST(ContactTime, BothRepresentationsAndStreamingAgree) {
  const ContactTime law(Inelastic(0.9), 1e-3);
  Simulation gaps(law, GapChain<double>(shock(400), 0.0)), held(law, GapChain<double>(shock(400), 0.0, true));
  Simulation positions(law, PositionChain<double>(shock(400), 0.0));
  for (const double t : {20.0, 60.0, 80.0}) {
    gaps.advance(t);
    held.advance(t);
    positions.advance(t);
    EXPECT_EQ(gaps.counts().collisions, held.counts().collisions);
    EXPECT_EQ(gaps.energy_lost(), held.energy_lost());
    EXPECT_EQ(gaps.counts().collisions, positions.counts().collisions);
    EXPECT_EQ(gaps.counts().below_cutoff, positions.counts().below_cutoff);
  }
  EXPECT_GT(gaps.counts().below_cutoff, 0U);
  EXPECT_LT(gaps.counts().below_cutoff, gaps.counts().collisions);
}

TEST(Merging, CollapseEndsInOneParticle) {
  const auto particles = three_particles();
  Simulation run(InelasticMerging(Inelastic(0.05), 1e-3), ClusterChain<double>(particles, 0.0));
  EXPECT_EQ(run.advance(100.0), Status::reached);
  EXPECT_EQ(run.counts().merges, 2U);
  const auto end = run.chain().configuration(run.chain().local_time(100.0));
  ASSERT_EQ(end.x.size(), 1U);
  EXPECT_EQ(end.m[0], 3.0);
  // The momentum is 0: the centre of mass rests at 4/3, all energy (1) is lost. A unit of rounding per collision,
  // some 12.
  EXPECT_NEAR(end.v[0], 0.0, 1e-15);
  EXPECT_NEAR(end.x[0], 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(run.energy_lost(), 1.0, 1e-15);
}

TEST(Merging, NeverReachedItIsThePlainLaw) {
  Simulation clusters(InelasticMerging(Inelastic(0.999), 0.0), ClusterChain<double>(shock(400), 0.0));
  Simulation gaps(Inelastic(0.999), GapChain<double>(shock(400), 0.0));
  for (const double t : {50.0, 150.0, 250.0}) {
    clusters.advance(t);
    gaps.advance(t);
    EXPECT_EQ(clusters.counts().collisions, gaps.counts().collisions);
    EXPECT_NEAR(clusters.energy_lost(), gaps.energy_lost(), 1e-12 * gaps.energy_lost());
  }
  EXPECT_EQ(clusters.counts().merges, 0U);
}

TEST(Merging, StreamingChangesNoBitAndTheLedgerHolds) {
  const auto particles = shock(400);
  const InelasticMerging law(Inelastic(0.9), 1e-3);
  Simulation streamed(law, ClusterChain<double>(particles, 0.0)), held(law, ClusterChain<double>(particles, 0.0, true));
  for (const double t : {50.0, 90.0, 150.0, 400.0}) {
    streamed.advance(t);
    held.advance(t);
    EXPECT_EQ(streamed.counts().collisions, held.counts().collisions);
    EXPECT_EQ(streamed.counts().merges, held.counts().merges);
    EXPECT_EQ(streamed.energy_lost(), held.energy_lost());
    const auto a = streamed.chain().configuration(streamed.chain().local_time(t));
    const auto b = held.chain().configuration(held.chain().local_time(t));
    EXPECT_EQ(a.gap, b.gap);
    EXPECT_EQ(a.v, b.v);
    EXPECT_EQ(a.m, b.m);
    const double left = particles->kinetic_energy() - streamed.energy_lost();
    EXPECT_NEAR(kinetic_energy(a, *particles), left, 1e-13 * particles->kinetic_energy());
    EXPECT_NEAR(momentum_gained(a, *particles), 0.0, 1e-12);
  }
  EXPECT_GT(streamed.counts().merges, 0U);
  EXPECT_EQ(streamed.chain().account().order_lost, 0U);
}

}  // namespace policies_test
}  // namespace cradle
