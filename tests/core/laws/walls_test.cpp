// Walls: the random speeds of thermal ones; of shaken ones the account of energy, frames, the bouncing ball and its
// first period doubling; piles that come to rest on floors, against sums of geometric series, and are let go; what is
// refused of all of them. (Every collision and account, in gaps and positions, against
// exact arithmetic or 100 digits: precision/exact_gas_test.cpp; in double: engine/same_bits_test.cpp; in segments:
// parallel/segments_test.cpp. Thermal equilibrium and mirrors: gravity_test.cpp.)
#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/engine/sticky_gas.hpp"
#include "cradle/tests/core/between_walls.hpp"
#include "cradle/tests/core/rational.hpp"

namespace cradle::test::walls_test {

// Particles that leave a wall of temperature 1 do so with the density v exp(-v^2/2): mean sqrt(pi/2), mean square 2.
TEST(Walls, ThermalSpeedsHaveTheirMoments) {
  constexpr int draws = 100000;
  for (const End end : {End::left, End::right}) {
    double sum = 0, squares = 0, above = 0;
    for (std::uint64_t k = 0; k < draws; ++k) {
      const double v = thermal_speed(3, 1, end, k);
      ASSERT_GT(v, 0);
      sum += v, squares += v * v, above += v > 2;
    }
    EXPECT_NEAR(sum / draws, std::sqrt(std::numbers::pi / 2), 4 * std::sqrt((2 - std::numbers::pi / 2) / draws));
    EXPECT_NEAR(squares / draws, 2, 4 * std::sqrt(4. / draws));
    EXPECT_NEAR(above / draws, std::exp(-2), 4 * std::sqrt(std::exp(-2) / draws));
  }
  EXPECT_NE(thermal_speed(3, 1, End::left, 0), thermal_speed(3, 1, End::right, 0));
  EXPECT_NE(thermal_speed(3, 1, End::left, 0), thermal_speed(3, 2, End::left, 0));
}

// A column on a shaken floor for a long time: the accounts and the closure drift by rounding alone.
TEST(ShakenWalls, AccountsHoldForLong) {
  for (const Shape shape : shapes) {
    const auto particles =
        between(-0.5, rmix<double>(12), wall(-2, shaken(shape, 0.25, 0.3), 0.9), wall(40, shaken(shape, 0.5, -1, 2)));
    auto run = mass_run(particles, Inelastic<double>(0.97, 1e-4));
    for (double t = 100; t <= 1000; t += 100) {
      ASSERT_EQ(run.advance(t), Status::reached);
      EXPECT_LT(unaccounted(run, *particles, t), 1e-11);
      EXPECT_TRUE(guards_hold(run, *particles, t));
      EXPECT_LT(std::abs(*configuration_at(run, t).closure_gap), 1e-9);
    }
    EXPECT_EQ(run.chain().account().order_lost, 0U);
    EXPECT_GT(run.counts().collisions, 10000U);
  }
}

// A phase later by a turn, a start later by a period, a frame that moves: all but rounding the same.
TEST(ShakenWalls, TheMotionIsPeriodic) {
  for (const Shape shape : shapes) {
    const auto x_at = [&](double phase, double start, double boost) {
      const auto particles =
          between(-0.5, list<double>({1, 2.5}, {boost, 0.5 + boost}), wall(0, shaken(shape, 0.25, phase), 0.9, boost));
      auto run = mass_run(particles, Inelastic<double>(0.95, 1e-2), {}, start);
      EXPECT_EQ(run.advance(start + 10), Status::reached);
      return configuration_at(run, start + 10).x[0] - 10 * boost;
    };
    const double x = x_at(0.3, 0, 0);
    EXPECT_NEAR(x_at(0.3 - 4 * std::numbers::pi, 0, 0), x, 1e-12);
    EXPECT_EQ(x_at(0.3, 64, 0), x);  // the phase is that at the start
    EXPECT_NEAR(x_at(0.3, 0, 0.375), x, 1e-11);
  }
}

// A turn takes 1 + 3.9e-17 where the frequency is the double next to 2 pi, which is the smaller one; one more unit of
// it makes that 1 - 1e-16. So half a turn before and after the k-th one the phase is on either side of the tip, by less
// than a double next to k shows.
TEST(ShakenWalls, AtATipTheTurnIsThatOfAllDigits) {
  const double below = 2 * std::numbers::pi, above = std::nextafter(below, 7);
  for (const int k : {1000, 10001, 654321}) {
    const auto before = WallMotion<double>(Shape::sawtooth, 0.25, below, 0).at({k + 0.5, 0});
    EXPECT_EQ(before.whole, k);
    EXPECT_TRUE(0.25 < before.rest && before.rest < 0.5) << before.rest - 0.5;
    const auto after = WallMotion<double>(Shape::sawtooth, 0.25, above, 0).at({k + 0.5, 0});
    EXPECT_EQ(after.whole, k + 1);
    EXPECT_TRUE(-0.5 <= after.rest && after.rest < -0.25) << after.rest + 0.5;
  }
}

// A ball of the restitution r on a floor A sin(omega t) under the acceleration g repeats one flight per period if it
// meets the floor where A omega cos(phi) = pi (g/omega) (1 - r)/(1 + r). With s = A omega^2 sin(phi)/g the map from one
// collision to the next has the determinant r^2 and the trace 1 + r^2 - (1 + r)^2 s, so periods double where
// (1 + r)^2 s = 2 (1 + r^2):  (A omega^2/g)^2 = (2 (1 + r^2)/(1 + r)^2)^2 + (pi (1 - r)/(1 + r))^2.
struct Ball {
  double restitution = 0.5;
  double doubling() const {
    const double r = restitution;
    return std::hypot(2 * (1 + r * r) / ((1 + r) * (1 + r)), std::numbers::pi * (1 - r) / (1 + r));
  }
  // The speeds of the last two collisions of many, from nearly the repeated flight; g = omega = 1.
  std::pair<double, double> last_speeds(double shaking, int collisions) const {
    const double cos = std::numbers::pi * (1 - restitution) / (1 + restitution) / shaking, phi = std::acos(cos);
    const double top = shaking * std::sin(phi) + std::numbers::pi * std::numbers::pi / 2;
    const auto particles = between(-1, list<double>({top + 1e-3}, {0}),
                                   wall(0, shaken(Shape::sine, shaking, phi - std::numbers::pi, 1), restitution));
    auto run = mass_run(particles, Inelastic<double>(1));
    std::pair<double, double> last;
    const auto observe = [&](const Collision<double>& c) { last = {last.second, c.closing_speed}; };
    EXPECT_EQ(run.advance(2 * std::numbers::pi * collisions, observe), Status::reached);
    return last;
  }
};
TEST(ShakenWalls, TheFirstPeriodDoublingOfABouncingBall) {
  for (const double r : {0.3, 0.5, 0.8}) {
    const Ball ball{r};
    const auto [even, odd] = ball.last_speeds(ball.doubling() - 2e-3, 5000);
    EXPECT_NEAR(even, odd, 1e-9);
    EXPECT_NEAR(even, std::numbers::pi * 2 / (1 + r), 1e-9);  // pi plus the floor's speed
    const auto [high, low] = ball.last_speeds(ball.doubling() + 2e-3, 5000);
    EXPECT_GT(std::abs(high - low), 1e-2);
  }
}

// What a floor of restitution 0 has stopped while it falls faster leaves it at once, at whatever phase it was met; and
// rounding decides nothing there.
TEST(ShakenWalls, AParticleThatWasStoppedIsLeftByAWallThatFallsFaster) {
  for (const Shape shape : {Shape::sine, Shape::parabola})
    for (int k = -60; k < 60; ++k) {
      const auto motion = std::make_shared<const WallMotion<double>>(shape, 1.5, 1.6, k / 10.);
      const auto particles = between(-1, list<double>({3}, {0.1}), wall(0, motion, 0, 0, 1000));
      Simulation run(Inelastic<double>(1), GapChain<double, WatchedMasses<double>>(particles, 0.));
      EXPECT_EQ(run.advance(30., [&](const Collision<double>& c) { ASSERT_GT(c.closing_speed, 0) << k; }),
                Status::reached);
      EXPECT_GT(run.counts().collisions, 3U) << k;
      EXPECT_LT(run.counts().collisions, 10U) << k;
      EXPECT_EQ(run.chain().account().uncertain, 0U) << k;
      const auto end = sample(run, 0., 30.);
      EXPECT_EQ(*end.front_left, *end.front_right) << k;
    }
}

// A wall that presses again, after the phase at which it would let go, holds until its next turn: a sine that
// accelerates by 2 p lets go at a twelfth of a turn, the parabola in the middle, the sawtooth at its tip.
TEST(ShakenWalls, AWallHoldsUntilItLetsGo) {
  const double pull = 0.5, turn = 2 * std::numbers::pi;
  const auto let_go = [&](Shape shape, double from) {
    const WallMotion<double> motion(shape, shape == Shape::parabola ? std::numbers::pi * std::numbers::pi / 8 : 1, 1,
                                    0);
    const Pair<double> since{from * turn, 0}, late{20, 0};
    const WallApproach<double> approach(0, 0, pull, splitter<double>(), {&motion, true, motion.release(pull)}, since);
    return (since.high + approach.rested(20 - since.high, late)) / turn;
  };
  for (const auto& [from, to] : {std::pair(-0.4, 1. / 12), std::pair(0., 1. / 12), std::pair(0.47, 13. / 12)})
    EXPECT_NEAR(let_go(Shape::sine, from), to, 1e-15);
  EXPECT_EQ(let_go(Shape::sine, 0.25), 0.25);  // it does not press there
  EXPECT_NEAR(let_go(Shape::parabola, -0.3), 0, 1e-15);
  EXPECT_NEAR(let_go(Shape::sawtooth, -0.3), 0.5, 1e-15);
  EXPECT_NEAR(let_go(Shape::sawtooth, 0.3), 0.5, 1e-15);
}

// ---- piles: particles that come to rest on one another on a floor

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

// ---- what is refused: of walls, of gravity and of floors on which particles rest

TEST(Walls, WhereTheyCannotBeIsSaid) {
  const auto one = list<double>({1}, {0}), two = list<double>({1, 2}, {0, 0}), ring = gaussian_ring(10, 10);
  const Shaking sine = shaken(Shape::sine, 0.5, std::numbers::pi / 2, 1);  // 0.5 to the right at the start
  const Wall<double> holds = wall(0, nullptr, 0.5, 0, 0.1), shaken_holds = wall(0, sine, 0.5, 0, 0.1);
  struct Row {
    double acceleration;
    Scene<double> particles;
    std::optional<Wall<double>> left = {}, right = {};
  };
  const Row refused[] = {{0, two, Wall<double>{1.}},
                         {0, two, Wall<double>{1.5}},
                         {0, two, {}, Wall<double>{2.}},
                         {0, two, Wall<double>{0., 0., 1.5}},
                         {0, two, Wall<double>{0., NAN}},
                         {0, two, thermal(0., -1)},
                         {0, ring, Wall<double>{-1.}},
                         {-1, ring},
                         {NAN, two},
                         {-1, two, Wall<double>{0., 0., 0.}},
                         {0, two, wall(0.75, sine)},
                         {0, two, wall(0, sine, 0)},
                         {-1, two, holds, wall(3, nullptr, 1, 0, 0.1)},
                         {-1, two, shaken_holds, wall(3, sine, 1)}};
  const Row accepted[] = {{0, two, Wall<double>{0.}, Wall<double>{3.}},
                          {1, two, Wall<double>{0., 0., 0.}},
                          {0, two, wall(0.25, sine)},
                          {0, one, wall(0, sine, 0, 0, 0.1)},
                          {-1, two, shaken_holds, wall(3, nullptr, 1)},
                          {-1, two, holds, wall(3, sine, 1)},
                          {-1, one, shaken_holds, wall(3, sine, 1, 0, 0.1)}};
  for (const auto& [a, particles, left, right] : refused)
    EXPECT_THROW(between(a, particles, left, right), std::invalid_argument) << a << ", " << left.has_value();
  for (const auto& [a, particles, left, right] : accepted) EXPECT_NO_THROW(between(a, particles, left, right)) << a;
  for (const auto& [amplitude, phase, frequency] :
       {std::tuple(0., 0., 1.), {1., 0., 0.}, {1., 0., -1.}, {double(NAN), 0., 1.}, {1., double(NAN), 1.}})
    EXPECT_THROW(shaken(Shape::sine, amplitude, phase, frequency), std::invalid_argument);
}

TEST(Walls, ChainsThatHaveNoneRefuseThem) {
  const auto one = list<double>({1}, {0});
  const Shaking sine = shaken(Shape::sine, 0.5);
  for (const auto& scene : {between(-1, one), between(0, one, wall(0, sine))})
    EXPECT_THROW(ClusterChain<double>(scene, 0.), std::invalid_argument);
  EXPECT_THROW(StickyGas<double>(between(-1, one), 0.), std::invalid_argument);
  EXPECT_THROW(PositionChain<double>(between(0, one, wall(0, sine, 0, 0, 0.1)), 0.), std::invalid_argument);
  const auto exact = between<Rational>(-1, list<Rational>({1, 2}, {0, 0}));  // which has no square roots
  EXPECT_THROW(GapChain<Rational>(exact, 0), std::invalid_argument);
  EXPECT_THROW(PositionChain<Rational>(exact, 0), std::invalid_argument);
  EXPECT_NO_THROW(gap_run<double>(between(0, one), Inelastic<double>(1)));
}

}  // namespace cradle::test::walls_test
