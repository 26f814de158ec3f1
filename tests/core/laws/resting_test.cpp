// Piles: particles that come to rest on one another on a floor. When they do, against sums of geometric series; a pile
// that is let go; laws with a cut-off or a contact time. (Motions and accounts against a gas in 100 digits:
// precision/exact_gas_test.cpp; what is refused: walls_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/tests/core/between_walls.hpp"

namespace cradle::test::resting_test {

// A ball from the height 1/2, at restitution 1/2, meets the floor at the speeds 2^-k and rests at the first one below
// 1/64, at t = 3 - 2^-6. A ball from the height 8 meets it at t = 4 and w = 4. The lower ball leaves the collision at 3
// downwards, the floor at 3/2, and the next collision, at the same time, at 3/8 downwards; the upper ball flies at
// (7/32) w. So it comes back as often as 4 (7/32)^n > 1/64, at times of a geometric series.
TEST(Resting, TwoBallsAgainstGeometricSeries) {
  const auto particles = between(-1, list<double>({0.5, 8}, {0, 0}), wall(0, nullptr, 0.5, 0, 1. / 64));
  auto run = mass_run(particles, Inelastic<double>(0.5));
  std::vector<double> lower, upper;  // times
  const auto add = [&](const Collision<double>& c) { (c.left < 0 ? lower : upper).push_back(c.time.value()); };
  EXPECT_EQ(run.advance(100., add), Status::reached);
  ASSERT_GT(lower.size(), 8U);
  EXPECT_NEAR(lower[7], 3 - 1. / 64, 1e-15);
  EXPECT_NEAR(lower[8], 4, 1e-15);
  double time = 4, w = 4;
  std::size_t k = 0;
  for (; w > 1. / 64; time += 2 * w * 7 / 32, w *= 7. / 32) {
    ASSERT_LT(k + 1, upper.size());
    EXPECT_NEAR(upper[k], time, 1e-14);
    EXPECT_NEAR(upper[k + 1], time, 1e-14);
    k += 2;
  }
  ASSERT_EQ(upper.size(), k + 1);  // the last one stays
  EXPECT_NEAR(upper[k], time, 1e-14);
  const auto c = run.configuration(100.);
  for (const double zero : {c.x[0], c.x[1], c.v[0], c.v[1], c.gap[0], c.closing_speed[0]}) EXPECT_NEAR(zero, 0, 1e-14);
  EXPECT_NEAR(run.energy_lost(), 8.5, 1e-14);
  EXPECT_NEAR(sample(run, 0., 100.).walls[0].momentum.value(), 200, 1e-11);  // both weights for that time
}

// One particle or three are let go where A omega^2 sin(omega t) = g, at the speed of the floor, and fly as one: the
// gaps between them stay 0. For a short time the gap to the floor is A omega^3 cos(phi) t^3/6 less what the next order
// has. A last one above, which falls with them from then on, meets them when its last closing speed has used up the
// gap.
TEST(Resting, APileIsLetGoAtTheExactTime) {
  const double amplitude = 0.25, omega = 3, quarter = std::numbers::pi / 2;
  const double phi = std::asin(1 / (amplitude * omega * omega)), t = (phi + quarter) / omega, after = 0.03;
  const double of_floor = amplitude * omega * std::cos(phi);
  const auto floor = wall(0, shaken(Shape::sine, amplitude, -quarter), 0.25, 0, 0.5);  // at its lowest place
  for (const std::size_t pile : {1U, 3U}) {
    SCOPED_TRACE(pile);
    std::vector<double> places, speeds(pile, 0);
    for (std::size_t i = 0; i < pile; ++i) places.push_back(-0.249 + 0.001 * static_cast<double>(i));
    places.push_back(1), speeds.push_back(1);
    auto run = mass_run(between(-1, list(places, speeds), floor), Inelastic<double>(1));
    ASSERT_EQ(run.advance(t + after), Status::reached);
    ASSERT_LT(run.last_collision_time(), t / 2);
    const auto c = run.configuration(t + after);
    const double x = amplitude * std::sin(phi) + of_floor * after - after * after / 2;
    for (std::size_t i = 0; i < pile; ++i) {
      EXPECT_NEAR(c.x[i], x, 1e-13);
      EXPECT_NEAR(c.v[i], of_floor - after, 1e-13);
      if (i > 0) {
        EXPECT_EQ(c.gap[i - 1], 0);
      }
    }
    const double gap = run.chain().gap_at(run.chain().first(), run.chain().local_time(t + after));
    EXPECT_NEAR(gap, of_floor * omega * omega * after * after * after / 6, gap / 4);
    const double above = 1 + t - t * t / 2, closing = of_floor - (1 - t);
    EXPECT_NEAR(c.gap[pile - 1], above - amplitude * std::sin(phi) - closing * after, 1e-13);
    EXPECT_NEAR(c.closing_speed[pile - 1], closing, 1e-13);
  }
}

// Where many inelastic particles are thrown together, collapses among them end by the law: the whole column comes to
// rest, with a cut-off or a contact time, on a floor that takes what falls on it (restitution 0) and on another.
TEST(Resting, AColumnComesToRest) {
  const auto at_rest = [](auto law, double of_floor) {
    const auto particles = between(-1, rmix<double>(20), wall(-1, nullptr, of_floor, 0, 0.05));
    auto run = mass_run(particles, law);
    EXPECT_EQ(run.advance(200.), Status::reached);
    const auto c = run.configuration(200.);
    for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(c.x[i], -1, 1e-12);
    for (const double gap : c.gap) EXPECT_EQ(gap, 0);
    EXPECT_LT(run.last_collision_time(), 150);
    EXPECT_EQ(run.account().order_lost, 0U);
  };
  for (const double of_floor : {0., 0.5}) {
    at_rest(Inelastic<double>(0.8, 0.02), of_floor);
    at_rest(ContactTime<double>(Inelastic<double>(0.8), 0.01), of_floor);
  }
}

}  // namespace cradle::test::resting_test
