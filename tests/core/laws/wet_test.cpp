// The wet law: its threshold, Newton's cradle, and the shock of an independent event-driven N-particle program at the
// paper's size, to its end. (Others are among the fixtures of engine/fixtures_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::wet_test {

TEST(WetLaw, ThresholdFromBothSides) {
  // u0 = 1/2, E = 1/4: closing at 1, mu = 1/2, sqrt(2 E/mu) = 1 exactly; equality merges.
  const Wet law(0.25);
  EXPECT_EQ(law(1.0, TwoMasses<double>{1, 1}).event, Event::merge);
  EXPECT_EQ(law(std::nextafter(1.0, 0.0), TwoMasses<double>{1, 1}).event, Event::merge);
  const double above = std::nextafter(1.0, 2.0), excess = above - 1;
  const auto passed = law(above, TwoMasses<double>{1, 1});
  EXPECT_EQ(passed.event, Event::pass);
  // w'^2 = (w - 1)(w + 1) to rounding: nothing cancels.
  EXPECT_NEAR(passed.closing, -std::sqrt(excess * (2 + excess)), 4e-16 * std::sqrt(2 * excess));
  EXPECT_EQ(passed.energy_lost, 0.25);
}

// The law decides without the root where it can: never other than the root would.
TEST(WetLaw, IsTheSameWhereItIsDecidedWithoutTheRoot) {
  const Wet law(0.05);
  for (const double left : {1.0, 3.0, 7e5, 1e12})
    for (const double right : {1.0, 2.5, 1e9}) {
      const double critical = std::sqrt(0.1 * (left + right) / (left * right));
      for (int k = 0; k <= 40; ++k) {  // the root itself is rounded in the 53rd bit
        EXPECT_EQ(law(critical * (1 - std::exp2(-k)), TwoMasses<double>{left, right}).event, Event::merge)
            << left << " " << right << " " << k;
        EXPECT_EQ(law(critical * (1 + std::exp2(-k)), TwoMasses<double>{left, right}).event, Event::pass)
            << left << " " << right << " " << k;
      }
    }
}

TEST(WetLaw, LosesTheSameEnergyAtAnyMass) {
  for (const double heavy : {1.0, 3.0, 1e6, 1e12}) {
    const Wet law(0.05);
    const double w = 1.25, u = 0.5;  // right particle at u, left at u + w
    const auto o = law(w, TwoMasses<double>{heavy, 1});
    const double left = u + w - o.to_left, right = u + o.to_right;
    // Energies of order `heavy`: what is left of 0.05 carries their rounding.
    const double before = heavy * (u + w) * (u + w) + u * u, after = heavy * left * left + right * right;
    EXPECT_NEAR((before - after) / 2, 0.05, 4e-16 * before) << heavy;
    EXPECT_NEAR(heavy * (o.to_left), o.to_right, 4e-16 * o.to_right) << heavy;
  }
}

// Slope of log10(maximum) in 13 bins of equal width in log10 t from 3 to 7.3, bins 3 to 13.
class Envelope {
 public:
  void add(double log_time, double value) {
    auto& largest = largest_.at(std::min<std::size_t>(static_cast<std::size_t>((log_time - 3) / 4.3 * 13), 12));
    largest = std::max(largest, value);
  }
  double exponent() const {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t bin = 2; bin < largest_.size(); ++bin) {
      const double at = 3 + 4.3 * (static_cast<double>(bin) + 0.5) / 13, height = std::log10(largest_[bin]);
      n += 1, x += at, y += height, xx += at * at, xy += at * height;
    }
    return (n * xy - x * y) / (n * xx - x * x);
  }

 private:
  std::array<double, 13> largest_{};
};

// Counts and masses of an independent program, the same in double and binary128; exponents against (17), 1/3 and -1/3,
// with the 0.03 that its fit (0.306, -0.347) allows; energy against the sticky law.
TEST(WetShock, SlowFig11ToTheEnd) {
  Simulation run(Wet<double>{0.05}, ClusterChain<double>{rshock<double>(20000000), 0.0});
  Envelope separation, speed;
  const auto until = [&](double t, std::uint64_t collisions, std::uint64_t merges) {
    ASSERT_EQ(run.advance(t), Status::reached);
    EXPECT_EQ(run.counts().collisions, collisions);
    EXPECT_EQ(run.counts().merges, merges);
    EXPECT_NEAR(run.energy_lost() / (0.125 * t), 1, 1e-6);
  };
  for (int k = 0; k < 1200; ++k) {
    const double log_time = 3 + 4.28 * k / 1199, time = std::pow(10, log_time);
    if (time > 1e7 && run.counts().collisions < 30041051) until(1e7, 30041051, 9999987);
    if (time > 1.9e7 && run.counts().collisions < 57079264) until(1.9e7, 57079264, 18999992);
    ASSERT_EQ(run.advance(time), Status::reached);
    const auto now = cloud(run.configuration(time));
    ASSERT_TRUE(now.left && now.right);
    separation.add(log_time, now.right->x - now.left->x);
    speed.add(log_time, std::max(std::abs(now.left->v), std::abs(now.right->v)));
    if (k < 1199) continue;
    EXPECT_EQ(now.left->mass, 8962047);
    EXPECT_EQ(now.right->mass, 10051479);
    EXPECT_GT((now.left->mass + now.right->mass) / now.mass, 0.9);
  }
  EXPECT_NEAR(separation.exponent(), 1.0 / 3, 0.03);
  EXPECT_NEAR(speed.exponent(), -1.0 / 3, 0.03);
  EXPECT_LE(run.chain().slots(), 300U);  // of 2e7 particles
}

}  // namespace cradle::test::wet_test
