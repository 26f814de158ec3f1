// Input that chains and initial states refuse, by exceptions that state what is wrong, what was found and what to do.
// Proves: no chain silently accepts any of it.
#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/texts.hpp"

namespace cradle::test::misuse_test {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

// It throws, with a message that begins with `what`, names what was found and ends in what to do.
void expect_refused(const std::function<void()>& construct, const std::string& what, const std::string& found) {
  const std::string message = message_of(construct);
  EXPECT_TRUE(begins(message, what));
  const auto open = message.find('('), close = message.find("): ");
  ASSERT_TRUE(open != std::string::npos && close != std::string::npos && open < close) << message;
  EXPECT_TRUE(has(message.substr(open, close - open), found)) << message;
  EXPECT_GT(message.size(), close + 3) << message;
}

TEST(Misuse, UnequalMassesInAChainForIdenticalOnes) {
  const auto particles = list<double>({0, 1, 2}, {1, 0, -1}, {3, 3, 5});
  expect_refused([&] { GapChain<double>(particles, 0.0); }, "unequal masses", "particle 2 has 5");
  EXPECT_NO_THROW((GapChain<double, IndividualMasses<double>>(particles, 0.0)));
  EXPECT_NO_THROW(GapChain<double>(list<double>({0, 1, 2}, {1, 0, -1}, {3, 3, 3}), 0.0));
}

// Sums that the type does not hold are refused, by chains and by the gas that has none.
TEST(Misuse, MassesAndSpeedsWhoseSumsAreOutOfRange) {
  const auto still_rows = [](double speed, double mass) {
    return std::make_shared<Rows<double>>(
        symmetric_rows(8, speed, 1.0, Displacement(still), MassPattern<double>({mass})));
  };
  const std::pair<const char*, Scene<double>> cases[] = {
      {"the kinetic energy", list<double>({0, 1, 2}, {1e160, -1e160, -2e160})},
      {"the kinetic energy", still_rows(1e160, 1)},
      {"the kinetic energy", still_rows(1e100, 1e150)},
      {"the kinetic energy", std::make_shared<Ring<double>>(8, 8., 1e160, gaussian_velocity(1, 0), still)},
      {"the kinetic energy", std::make_shared<Cold<double>>(8, 1., HotPlace::left, kicked(0, 1e160), still)},
      {"the mass", list<double>({0, 1}, {0, -1e-300}, {1e308, 1e308})},
      {"the mass", still_rows(1e-300, 1e308)},
      {"the momentum", list<double>({0, 1}, {1e10, -1e10}, {1e300, 1e300})},
  };
  for (const auto& [what, particles] : cases) {
    const std::string message = std::string(what) + " of all particles overflows";
    const auto& all = particles;
    expect_refused([&] { GapChain<double, IndividualMasses<double>>(all, 0.0); }, message, "no finite number");
    expect_refused([&] { ClusterChain<double>(all, 0.0); }, message, "no finite number");
    expect_refused([&] { StickyGas<double>(all, 0.0); }, message, "no finite number");
  }
  const std::shared_ptr<const Particles<double>> slow[] = {list<double>({0, 1}, {1e-170, -1e-170}),
                                                           list<double>({0, 1}, {1e-150, -1e-150}, {1e-10, 1e-10}),
                                                           still_rows(1e-160, 1)};
  for (const auto& all : slow)
    expect_refused([&] { ClusterChain<double>(all, 0.0); }, "the kinetic energy of all particles underflows",
                   "all its digits");
  const auto light = list<double>({1e-150, 2e-150, 5e-150}, {1, 0, 0}, {1e-200, 1e-200, 1e-200});
  expect_refused([&] { StickyGas<double>(light, 0.0); }, "the mass times the position", "all its digits");
  EXPECT_NO_THROW(ClusterChain<double>(list<double>({0, 1}, {0, 0}), 0.0));
  EXPECT_NO_THROW(ClusterChain<double>(list<double>({0, 1}, {1e-140, -1e-140}), 0.0));
  // The square of a momentum is not needed: masses of 1e200 at unit speeds are accepted.
  const auto heavy = list<double>({0, 1}, {1, 0.5}, {1e200, 1e200});
  EXPECT_NO_THROW((GapChain<double, IndividualMasses<double>>(heavy, 0.0)));
  EXPECT_NEAR(heavy->energy_to_lose() / 6.25e198, 1, 1e-14);  // mu w^2/2, of a difference of terms ten times as large
}

TEST(Misuse, ARingInAbsolutePositions) {
  const auto particles = list<double>({0, 1, 2}, {1, 0, -1}, {}, 10);
  expect_refused([&] { PositionChain<double>(particles, 0.0); }, "a ring in absolute positions", "circumference 10");
}

// Laws that a chain cannot follow are refused by the compiler: a chain in closing speeds knows no merging or passing,
// one of clusters remembers no collisions.
static_assert(CollidesBy<GapChain<double, IndividualMasses<double>>, Inelastic<double>>);
static_assert(CollidesBy<GapChain<double>, ContactTime<double>> &&
              CollidesBy<PositionChain<double>, ContactTime<double>>);
static_assert(!CollidesBy<GapChain<double, IndividualMasses<double>>, Wet<double>>);
static_assert(!CollidesBy<PositionChain<double>, Sticky<double>>);
static_assert(CollidesBy<ClusterChain<double>, Wet<double>> && CollidesBy<ClusterChain<double>, Inelastic<double>>);
static_assert(!CollidesBy<ClusterChain<double>, ContactTime<double>>);

TEST(Misuse, AStartThatIsNoTime) {
  const auto particles = list<double>({0, 1, 2}, {1, 0, -1});
  for (const double start : {infinity, -infinity, nan}) {
    expect_refused([&] { GapChain<double>(particles, start); }, "time of the start is not finite",
                   std::to_string(start));
    expect_refused([&] { ClusterChain<double>(particles, start); }, "time of the start", std::to_string(start));
    expect_refused([&] { PositionChain<double>(particles, start); }, "time of the start", std::to_string(start));
  }
}

TEST(Misuse, OddNumbersOfParticlesForTwoEqualRows) {
  for (const ParticleIndex n : {1, 7, 101})
    expect_refused([&] { symmetric_rows<double>(n, 0.5, 1, still); }, "an odd number of particles", std::to_string(n));
  EXPECT_EQ(symmetric_rows<double>(8, 0.5, 1, still).count(), 8);
  expect_refused([&] { symmetric_rows<double>(0, 0.5, 1, still); }, "a row without particles", "0");
}

TEST(Misuse, RowsOfNumbersThatAreNone) {
  const auto rows = [](Row<double> left, Row<double> right, std::optional<CentralParticle<double>> centre = {}) {
    return [=] { Rows<double>(left, right, centre, still); };
  };
  const Row<double> left{2, 1, 1}, right{2, -1, 1};
  EXPECT_NO_THROW(rows(left, right, CentralParticle<double>{1, 0})());
  for (const double none : {infinity, -infinity, nan}) {
    const std::string found = std::to_string(none);
    expect_refused(rows({2, none, 1}, right), "velocity of the left row is not finite", found);
    expect_refused(rows(left, {2, none, 1}), "velocity of the right row is not finite", found);
    expect_refused(rows({2, 1, none}, right), "spacing of the left row is not finite", found);
    expect_refused(rows(left, {2, -1, none}), "spacing of the right row is not finite", found);
    expect_refused(rows(left, right, CentralParticle<double>{none, 0}), "mass of the central particle is not finite",
                   found);
    expect_refused(rows(left, right, CentralParticle<double>{1, none}),
                   "velocity of the central particle is not finite", found);
  }
  expect_refused(rows({2, 1, 0}, right), "a row's spacing is not positive", "0.0");
  expect_refused(rows({2, -1, 1}, right), "the rows do not approach", "left -1");
  expect_refused(rows(left, right, CentralParticle<double>{0, 0}), "central mass is not positive", "0.0");
  expect_refused(rows(left, right, CentralParticle<double>{1, 2}), "the central particle runs away", "2.0");
  expect_refused([] { uniform_displacement(0.5, 1, 0); }, "perturbation out of range", "0.5");
}

TEST(Misuse, ListsOfNumbersThatAreNone) {
  for (const double none : {infinity, -infinity, nan}) {
    const std::string found = std::to_string(none);
    // A single particle has no neighbour to be out of order with.
    for (const auto& [n, particle] : {std::pair(1U, 0U), {3U, 0U}, {3U, 1U}, {3U, 2U}}) {
      std::vector<double> x, v(n, 0.), m(n, 1.);
      for (std::size_t i = 0; i < n; ++i) x.push_back(static_cast<double>(i));
      std::vector<double> bad_x = x, bad_v = v, bad_m = m;
      bad_x[particle] = bad_v[particle] = bad_m[particle] = none;
      const std::string which = "particle " + std::to_string(particle);
      expect_refused([&] { List<double>(bad_x, v, m); }, "position of " + which + " is not finite", found);
      expect_refused([&] { List<double>(x, bad_v, m); }, "velocity of " + which + " is not finite", found);
      expect_refused([&] { List<double>(x, v, bad_m); }, "mass of " + which + " is not finite", found);
      expect_refused([&] { List<double>(x, v, m, none); }, "circumference is not finite", found);
    }
  }
  expect_refused([] { List<double>({0, 1}, {0, 0}, {1, -2}); }, "particle 1 has no positive mass", "-2");
  expect_refused([] { List<double>({0, 1}, {0}); }, "lists of different lengths", "2 positions, 1 velocities");
  expect_refused([] { List<double>({1, 1}, {0, 0}); }, "particles 0 and 1 are not in order", "at 1.0");
  expect_refused(
      [] {
        list<double>({0, 1}, {0, 0}, {}, 1);
      },
      "the particles do not fit on the ring", "circumference 1");
  expect_refused([] { List<double>({0, 2}, {0, 0}, {}, -9); }, "circumference is negative", "-9");
}

TEST(Misuse, RingsOfNumbersThatAreNone) {
  for (const double none : {infinity, nan}) {
    expect_refused([&] { Ring<double>(3, none, 1, still, still); }, "length of the ring is not finite",
                   std::to_string(none));
    expect_refused([&] { Ring<double>(3, 1, none, still, still); },
                   "standard deviation of the velocities is not finite", std::to_string(none));
  }
  expect_refused([] { Ring<double>(3, -2, 1, still, still); }, "length or variance", "length -2");
  expect_refused([] { Ring<double>(3, 0, 1, still, still); }, "length or variance", "length 0");
  expect_refused([] { Ring<double>(3, 1, 0, still, still); }, "length or variance", "standard deviation 0");
  EXPECT_THROW(Ring<double>(0, 1, 1, still, still), std::invalid_argument);
}

}  // namespace cradle::test::misuse_test
