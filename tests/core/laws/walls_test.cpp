// Walls: the random speeds of thermal ones; of shaken ones the account of energy, frames, the bouncing ball and its
// first period doubling; what is refused of all of them. (Every collision and account, in gaps and positions, against
// exact arithmetic or 100 digits: precision/exact_gas_test.cpp; in double: engine/same_bits_test.cpp; in segments:
// parallel/segments_test.cpp. Thermal equilibrium and mirrors: gravity_test.cpp. When what rests is let go:
// resting_test.cpp.)
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
