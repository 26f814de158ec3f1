// The wet law: its threshold, and the shocks of an independent event-driven N-body program (the same counts in double,
// binary128 and 100 digits), at the paper's sizes.

#include <gtest/gtest.h>

#include <cmath>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/core/rows.hpp"
#include "cradle/core/simulation.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle {
namespace {

TEST(WetLaw, ThresholdFromBothSides) {
  // u0 = 1/2, E = 1/4: closing at 1, mu = 1/2, sqrt(2 E/mu) = 1 exactly; equality merges.
  const Wet law(0.25);
  EXPECT_EQ(law(1.0, 1.0, 1.0).event, Event::merge);
  EXPECT_EQ(law(std::nextafter(1.0, 0.0), 1.0, 1.0).event, Event::merge);
  const double above = std::nextafter(1.0, 2.0), excess = above - 1;
  const auto passed = law(above, 1.0, 1.0);
  EXPECT_EQ(passed.event, Event::pass);
  // w'^2 = (w - 1)(w + 1) to rounding: nothing cancels.
  EXPECT_NEAR(passed.closing, -std::sqrt(excess * (2 + excess)), 4e-16 * std::sqrt(2 * excess));
  EXPECT_EQ(passed.energy_lost, 0.25);
}

TEST(WetLaw, LosesTheSameEnergyAtAnyMass) {
  for (const double heavy : {1.0, 3.0, 1e6, 1e12}) {
    const Wet law(0.05);
    const double w = 1.25, u = 0.5;  // right body at u, left at u + w
    const auto o = law(w, heavy, 1.0);
    const double left = u + w - o.to_left, right = u + o.to_right;
    // Energies of order `heavy`: what is left of 0.05 carries their rounding.
    const double before = heavy * (u + w) * (u + w) + u * u, after = heavy * left * left + right * right;
    EXPECT_NEAR((before - after) / 2, 0.05, 4e-16 * before) << heavy;
    EXPECT_NEAR(heavy * (o.to_left), o.to_right, 4e-16 * o.to_right) << heavy;
  }
}

struct Sample {
  double time;
  std::uint64_t contacts, merges;
  double energy;
};

void expect_samples(BodyIndex bodies, double loss, const std::vector<Sample>& samples) {
  const auto rows = std::make_shared<Rows<double>>(symmetric_rows(bodies, 0.5, 1.0, test::rshock_displacement));
  Simulation run(Wet<double>{loss}, ClusterChain<double>{rows, 0.0});
  for (const auto& s : samples) {
    ASSERT_EQ(run.advance(s.time), Status::reached);
    EXPECT_EQ(run.counts().contacts, s.contacts) << s.time;
    EXPECT_EQ(run.counts().merges, s.merges) << s.time;
    EXPECT_NEAR(rows->kinetic_energy() - run.energy_lost(), s.energy, 1e-12 * rows->kinetic_energy()) << s.time;
  }
  EXPECT_EQ(run.chain().account().order_lost, 0U);
}

TEST(WetShock, UntilTheRowsAreUsedUpAndAfter) {
  expect_samples(200, .01,
                 {{20, 171, 0, 23.29},
                  {55, 851, 11, 16.5082234265726200},
                  {100, 1169, 84, 13.7984254962899249},
                  {150, 1911, 127, 6.64337178827478268},
                  {250, 2545, 191, .666296741488632748},
                  {400, 2546, 192, .665686071625090766}});
}

TEST(WetShock, Fig6) {
  expect_samples(50000, 1e-4,
                 {{2000, 1724590, 0, 6077.541},
                  {4999, 7682229, 0, 5481.7771},
                  {6000, 8897750, 1918, 5360.32405660858910},
                  {9000, 9477159, 8139, 5302.85558842691832},
                  {12000, 12153997, 9771, 5035.27051471133100}});
}

TEST(WetShock, Fig11HoldsOnlyTheActiveZone) {
  expect_samples(20000000, .05, {{1e5, 299358, 99994, 2487499.86929305}, {1e6, 2999594, 999992, 2375000.15424516508}});
}

TEST(WetShock, SlowFig11ToTheEnd) {
  expect_samples(20000000, .05,
                 {{1e7, 30041051, 9999987, 1249999.99953752}, {1.9e7, 57079264, 18999992, 125001.465920690406}});
}

}  // namespace
}  // namespace cradle
