// Shaken walls: gaps against positions, frames, mirrors; saved states; the account of energy; the bouncing ball and its
// first period doubling; a particle that rests on a floor and is let go; what is refused.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "cradle/core/chains/cluster_chain.hpp"
#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/compare.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/core/saved.hpp"

namespace shaken_walls_test {

using namespace cradle;
using namespace cradle::test;

template <class Chain> using RunOf = Simulation<double, Inelastic<double>, Chain>;
using Gaps = GapChain<double, IndividualMasses<double>, Gravity<double>>;
using Places = PositionChain<double, Gravity<double>>;
constexpr Shape shapes[] = {Shape::sawtooth, Shape::parabola, Shape::sine};

struct Shaken {
  Shape shape;
  double amplitude, frequency, phase;
};
Wall<double> wall(double position, const Shaken& by, double restitution = 1, double speed = 0, double rest_speed = 0) {
  return {.position = position,
          .speed = speed,
          .restitution = restitution,
          .motion = std::make_shared<WallMotion<double>>(by.shape, by.amplitude, by.frequency, by.phase),
          .rest_speed = rest_speed};
}
Scene<double> between(double acceleration, const Scene<double>& particles, std::optional<Wall<double>> left,
                      std::optional<Wall<double>> right = {}) {
  return std::make_shared<Walled<double>>(particles, std::move(left), std::move(right), acceleration);
}
template <class Chain = Gaps> RunOf<Chain> run_of(const Scene<double>& particles, const Inelastic<double>& law) {
  return {law, Chain(particles, 0.)};
}
// What is left of the energy beyond what walls gave and what was lost, at most over the sizes of these.
template <class R> double unaccounted(const R& run, const Particles<double>& particles, double t) {
  const auto c = configuration_at(run, t);
  const auto now = sample(run, 0., t);
  const double potential = potential_energy(c, particles, t);
  return std::abs(now.energy + potential - (particles.mechanical_energy() - now.energy_lost + now.given)) /
         (now.energy + std::abs(potential) + now.energy_lost + std::abs(now.given));
}
template <class R> bool guards_hold(const R& run, const Particles<double>& particles, double t) {
  return !guarded(configuration_at(run, t), particles, run.counts().collisions,
                  particles.mechanical_energy() - run.energy_lost(t), t, run.last_collision_time(), 0., true)
              .broken;
}

// The chain in gaps and that in positions make the same collisions, with and without gravity, between walls that are
// shaken in different ways; energy and the closure between the walls are kept.
TEST(ShakenWalls, CoordinatesAgree) {
  for (const Shape shape : shapes)
    for (const double a : {-0.0625, 0., 0.0625})
      for (const bool both : {false, true}) {
        SCOPED_TRACE(std::to_string(int(shape)) + " " + std::to_string(a) + " " + std::to_string(both));
        const auto left = wall(-1, {shape, 0.25, 3, 0.3}, 0.9, 0.01);
        const auto right = both ? wall(24, {shape, 0.5, 2, -1}) : Wall<double>{24.};
        const auto particles = between(a, rmix<double>(20), left, right);
        const Inelastic<double> law(0.95, 1e-2);
        auto gaps = run_of(particles, law);
        auto places = run_of<Places>(particles, law);
        Sequence of_gaps, of_places;
        EXPECT_EQ(gaps.advance(16, [&](const Collision<double>& c) { of_gaps.add(c.left); }), Status::reached);
        EXPECT_EQ(places.advance(16, [&](const Collision<double>& c) { of_places.add(c.left); }), Status::reached);
        EXPECT_GT(gaps.counts().collisions, 50U);
        const auto& walls = gaps.chain().walls();
        EXPECT_GT(walls.tally(End::left).collisions + walls.tally(End::right).collisions, 1U);
        EXPECT_EQ(of_gaps, of_places);
        const auto c = configuration_at(gaps, 16.), d = configuration_at(places, 16.);
        for (std::size_t j = 0; j < c.x.size(); ++j) {
          EXPECT_NEAR(c.x[j], d.x[j], 1e-9);
          EXPECT_NEAR(c.v[j], d.v[j], 1e-9);
        }
        EXPECT_LT(std::abs(*c.closure_gap), 1e-12);
        EXPECT_LT(std::abs(*c.closure_speed), 1e-13);
        EXPECT_LT(unaccounted(gaps, *particles, 16.), 1e-13);
        EXPECT_LT(unaccounted(places, *particles, 16.), 1e-13);
        EXPECT_TRUE(guards_hold(gaps, *particles, 16.) && guards_hold(places, *particles, 16.));
      }
}

// A column on a shaken floor for a long time: the accounts and the closure drift by rounding alone.
TEST(ShakenWalls, AccountsHoldForLong) {
  for (const Shape shape : shapes) {
    const auto particles =
        between(-0.5, rmix<double>(12), wall(-2, {shape, 0.25, 3, 0.3}, 0.9), wall(40, {shape, 0.5, 2, -1}));
    auto run = run_of(particles, Inelastic<double>(0.97, 1e-4));
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

// The mirror image has the mirrored gaps, bit for bit.
TEST(ShakenWalls, AMirrorImage) {
  const auto particles = rmix<double>(30);
  std::vector<double> x, v;
  for (ParticleIndex b = 30; b-- > 0;) x.push_back(-particles->position(b)), v.push_back(-particles->velocity(b));
  for (const Shape shape : shapes) {
    const Shaken low{shape, 0.5, 3, 0.25}, high{shape, 0.125, 7, 1};
    auto run =
        run_of(between(-0.5, particles, wall(-1, low, 0.9, 0.0625), wall(33, high)), Inelastic<double>(0.95, 1e-2));
    auto mirrored =
        run_of(between(0.5, list(x, v), wall(-33, high), wall(1, low, 0.9, -0.0625)), Inelastic<double>(0.95, 1e-2));
    run.advance(30), mirrored.advance(30);
    EXPECT_GT(run.counts().collisions, 300U);
    auto gap = configuration_at(mirrored, 30.).gap;
    std::reverse(gap.begin(), gap.end());
    EXPECT_EQ(configuration_at(run, 30.).gap, gap);
  }
}

// A phase later by a turn, a start later by a period, a frame that moves: all but rounding the same.
TEST(ShakenWalls, TheMotionIsPeriodic) {
  for (const Shape shape : shapes) {
    const auto x_at = [&](double phase, double start, double boost) {
      const auto particles =
          between(-0.5, list<double>({1, 2.5}, {boost, 0.5 + boost}), wall(0, {shape, 0.25, 3, phase}, 0.9, boost));
      RunOf<Gaps> run(Inelastic<double>(0.95, 1e-2), Gaps(particles, start));
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

TEST(ShakenWalls, TheSameAtAnyCadenceAndFromASavedState) {
  for (const Shape shape : shapes) {
    const auto particles =
        between(-0.25, rmix<double>(20), wall(-1., {shape, 0.25, 3, 0.3}, 0.9), wall(21., {shape, 0.5, 2, 0}));
    const Inelastic<double> law(0.97, 1e-3);
    const auto check = [](const auto& later, const auto& whole) {
      EXPECT_TRUE(identical(configuration_at(later, 20.), configuration_at(whole, 20.)));
    };
    expect_same_from_anywhere([&] { return run_of(particles, law); }, 0.5, 6.1, 20, check);
    expect_same_from_anywhere([&] { return run_of<Places>(particles, law); }, 0.5, 6.1, 20, check);
    auto once = run_of(particles, law), often = run_of(particles, law);
    once.advance(20);
    for (double t = 0; t <= 20; t += 0.37) often.advance(t);
    often.advance(20);
    EXPECT_TRUE(identical(configuration_at(once, 20.), configuration_at(often, 20.)));
    RunOf<Gaps> few_bits(law, Gaps(particles, 0.), {}, 3), many_bits(law, Gaps(particles, 0.), {}, 20);
    few_bits.advance(20), many_bits.advance(20);
    EXPECT_TRUE(identical(configuration_at(few_bits, 20.), configuration_at(many_bits, 20.)));
  }
}

// Between a sawtooth of the speed V and a wall at rest an elastic particle gains 2 V at every tooth that it meets.
TEST(ShakenWalls, ASawtoothGivesItsSpeed) {
  const double speed = 0.25 * 3 / std::numbers::pi;
  const auto particles = between(0, list<double>({1}, {-1}), wall(0, {Shape::sawtooth, 0.25, 3, 0}), Wall<double>{5.});
  auto run = run_of(particles, Inelastic<double>(1));
  std::vector<double> closing;
  run.advance(40, [&](const Collision<double>& c) {
    if (c.left < 0) closing.push_back(c.closing_speed);
  });
  ASSERT_GT(closing.size(), 10U);
  for (std::size_t k = 0; k < closing.size(); ++k) EXPECT_NEAR(closing[k], 1 + double(2 * k + 1) * speed, 1e-13);
  EXPECT_NEAR(sample(run, 0.5, 40.).given, sample(run, 0.5, 40.).energy - 0.5, 1e-12);
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
                                   wall(0, {Shape::sine, shaking, 1, phi - std::numbers::pi}, restitution));
    auto run = run_of(particles, Inelastic<double>(1));
    std::pair<double, double> last;
    EXPECT_EQ(run.advance(2 * std::numbers::pi * collisions,
                          [&](const Collision<double>& c) {
                            last = {last.second, c.closing_speed};
                          }),
              Status::reached);
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

// A floor with A omega^2 < g never lets a ball go that it holds; the ball then has the floor's motion.
TEST(ShakenWalls, ABallComesToRest) {
  for (const Shape shape : shapes)
    for (const double amplitude : {0.09, 0.2}) {
      const auto floor = wall(0, {shape, amplitude, 3, 0.2}, 0.25, 0.0625, 0.05);
      const auto particles = between(-1, list<double>({0.3}, {0}, {1.5}), floor);
      auto run = run_of(particles, Inelastic<double>(1));
      int resting = 0;
      for (double t = 0.01; t < 40; t += 0.0101) {
        ASSERT_EQ(run.advance(t), Status::reached);
        const auto now = configuration_at(run, t);
        const auto at_floor = at_wall(*particles, -1, Pair<double>{t, 0});
        const double gap = run.chain().gap_at(run.chain().first(), run.chain().local_time(t));
        ASSERT_GE(gap, -1e-15);
        ASSERT_NEAR(now.x[0], at_floor.x.value() + gap, 1e-14);
        if (gap == 0) {
          ++resting;
          ASSERT_NEAR(now.v[0], at_floor.v.value(), 1e-14);
        }
        ASSERT_LT(unaccounted(run, *particles, t), 1e-14);
        ASSERT_TRUE(guards_hold(run, *particles, t));
      }
      EXPECT_GT(resting, 50);
      const bool held = shape != Shape::sawtooth && amplitude == 0.09;  // the sawtooth drops from under it
      EXPECT_EQ(run.counts().collisions < 10, held) << int(shape);
      const auto momentum = sample(run, 0., 40.).walls[0].momentum.value();
      EXPECT_NEAR(momentum, 1.5 * (configuration_at(run, 40.).v[0] + 40), 1e-12);
    }
}

// From rest on A sin(omega t) a ball is let go where A omega^2 sin(omega t) = g, at the speed of the floor there. Then
// it flies freely.
TEST(ShakenWalls, ABallIsLetGoAtTheExactTime) {
  const double amplitude = 0.25, omega = 3, phi = std::asin(1 / (amplitude * omega * omega)), go = phi / omega;
  const auto floor = wall(0, {Shape::sine, amplitude, omega, 0}, 0.25, 0, 0.5);
  // It meets the floor soon after the lowest place, so slowly that it stays.
  const double start = 0.75 * 2 * std::numbers::pi / omega;
  const auto particles = between(-1, list<double>({1e-3}, {amplitude * omega}), floor);
  auto run = run_of(particles, Inelastic<double>(1));
  const double period = 2 * std::numbers::pi / omega;
  ASSERT_EQ(run.advance(start), Status::reached);
  int flights = 0;
  for (int k = 1; k < 50; ++k) {
    const double after = 0.05, t = go + k * period;
    ASSERT_EQ(run.advance(t + after), Status::reached);
    if (run.last_collision_time() > t) continue;  // it was flying
    const double x = amplitude * std::sin(phi) + amplitude * omega * std::cos(phi) * after - after * after / 2;
    const double gap = run.chain().gap_at(run.chain().first(), run.chain().local_time(t + after));
    if (std::abs(configuration_at(run, t + after).x[0] - x) > 1e-6) continue;
    ++flights;
    EXPECT_NEAR(configuration_at(run, t + after).x[0], x, 1e-13);
    // For a short time the gap is A omega^3 cos(phi) t^3/6 less what the next order has.
    EXPECT_NEAR(gap, amplitude * omega * omega * omega * std::cos(phi) * after * after * after / 6, gap / 4);
  }
  EXPECT_GT(flights, 5);
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

TEST(ShakenWalls, ARestingStateIsSaved) {
  const auto particles = between(-1, list<double>({0.3}, {0}), wall(0, {Shape::sine, 0.2, 3, 0.2}, 0.25, 0, 0.05));
  expect_same_from_anywhere([&] { return run_of(particles, Inelastic<double>(1)); }, 0.5, 0.73, 12,
                            [](const auto& later, const auto& whole) {
                              EXPECT_TRUE(identical(configuration_at(later, 12.), configuration_at(whole, 12.)));
                            });
}

TEST(ShakenWalls, WhereTheyCannotBeIsSaid) {
  const auto particles = list<double>({1, 2}, {0, 0});
  const Shaken sine{Shape::sine, 0.5, 1, std::numbers::pi / 2};
  EXPECT_NO_THROW(between(0, particles, wall(0.25, sine)));
  EXPECT_THROW(between(0, particles, wall(0.75, sine)), std::invalid_argument);  // at 1.25 at the start
  EXPECT_THROW(between(0, particles, wall(0, sine, 0)), std::invalid_argument);
  const auto one = list<double>({1}, {0});
  EXPECT_NO_THROW(between(0, one, wall(0, sine, 0, 0, 0.1)));
  EXPECT_THROW(run_of<Places>(between(0, one, wall(0, sine, 0, 0, 0.1)), Inelastic<double>(1)), std::invalid_argument);
  for (const Shaken& wrong : {Shaken{Shape::sine, 0, 1, 0}, Shaken{Shape::sine, 1, 0, 0}, Shaken{Shape::sine, 1, -1, 0},
                              Shaken{Shape::sine, NAN, 1, 0}, Shaken{Shape::sine, 1, 1, NAN}})
    EXPECT_THROW(wall(0, wrong), std::invalid_argument);
  const auto shaken = between(0, particles, wall(0, sine));
  EXPECT_THROW(gap_run<double>(shaken, Inelastic<double>(1)), std::invalid_argument);
  EXPECT_THROW(position_run<double>(shaken, Inelastic<double>(1)), std::invalid_argument);
  EXPECT_THROW(ClusterChain<double>(shaken, 0.), std::invalid_argument);
}

}  // namespace shaken_walls_test
