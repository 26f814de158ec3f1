// Proofs with walls under gravity. Proves: what the checker says of collisions on floors and at ceilings, at rest, in
// motion, inelastic and thermal, is what 100 digits give; a run that is wrong in one collision is never proved, nor is
// one that leaves out how a particle touches a ceiling; a bouncing ball is known up to the rounding of
// sums.
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/core/initial/rows.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"
#include "cradle/tests/precision/wrong_runs.hpp"

namespace certify_gravity_test {

using namespace cradle;
using namespace cradle::test;
using namespace cradle::test::drawn;

// All collisions in 100 digits, if there are not too many.
struct WideRun {
  Gas<bin_float> gas;
  Collisions collisions;
  bool ended = false;
};
WideRun wide_run(Gas<bin_float> gas) {
  WideRun run{std::move(gas), {}};
  while (run.collisions.size() < most_collisions) {
    const auto next = run.gas.next(bin_float(until));
    if (!next) break;
    run.collisions.push_back(*next);
  }
  run.ended = run.collisions.size() < most_collisions;
  run.gas.time = until;
  return run;
}
WideRun wide_run(const Drawn& d) { return wide_run(converted<bin_float>(gas_of(d))); }

void expect_proved(const Checker<B>& checker, const Drawn& d, const Gas<bin_float>& gas) {
  const CertainState<B> end = checker.state_at(B(until));
  EXPECT_TRUE(holds_wide(end.energy, gas.energy()));
  checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
    EXPECT_TRUE(holds_wide(x, gas.place(gas.cell_of(particle)))) << particle;
    EXPECT_TRUE(holds_wide(v, gas.velocity(gas.cell_of(particle)))) << particle;
  });
  ASSERT_EQ(end.front_left.has_value(), gas.outermost(true) != nullptr);
  if (end.front_left) {
    EXPECT_TRUE(holds_wide(*end.front_left, gas.place(*gas.outermost(true))));
    EXPECT_TRUE(holds_wide(*end.front_right, gas.place(*gas.outermost(false))));
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!d.walls[side]) continue;
    const GasWall<bin_float>& wall = *gas.walls[side];
    EXPECT_EQ(end.walls[side].collisions, wall.collisions);
    EXPECT_TRUE(holds_wide(end.walls[side].given, wall.given));
    EXPECT_TRUE(holds_wide(end.walls[side].momentum, wall.momentum));
    EXPECT_TRUE(holds_wide(end.walls[side].dissipated, wall.lost));
  }
}

TEST(CertifyGravity, WhatIsProvedIsWhatAHundredDigitsGive) {
  std::uint64_t counted = 0, on_floors = 0, at_ceilings = 0, on_thermal = 0, below = 0;
  for (std::uint64_t number = 0; number < 600; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_falling(number);
    const WideRun run = wide_run(d);
    if (!run.ended) continue;
    Checker<B> checker(particles_of<B>(d), law_of(d));
    const Collisions collisions = made(d);
    if (!proved(checker, collisions)) continue;
    ++counted;
    ASSERT_FALSE(run.gas.tied);
    ASSERT_EQ(collisions, run.collisions);
    EXPECT_EQ(checker.proved().below_cutoff, run.gas.below_cutoff);
    expect_proved(checker, d, run.gas);
    double widest = 0;
    checker.for_each(B(until),
                     [&](ParticleIndex, const B&, const B& x, const B&) { widest = std::max(widest, x.radius()); });
    EXPECT_LT(widest, 1e-12) << "not by being wide";
    for (std::size_t side = 0; side < 2; ++side) {
      if (!d.walls[side]) continue;
      const std::uint64_t of_wall = run.gas.walls[side]->collisions;
      ((side == 0) == (d.acceleration < 0) ? on_floors : at_ceilings) += of_wall;
      if (d.walls[side]->temperature > 0) on_thermal += of_wall;
      if (d.walls[side]->temperature == 0) below += run.gas.below_cutoff;
    }
  }
  EXPECT_GE(counted, 400U);
  EXPECT_GE(on_floors, 1000U);
  EXPECT_GE(at_ceilings, 100U);
  EXPECT_GE(on_thermal, 200U);
  EXPECT_GE(below, 100U);
  RecordProperty("proved", static_cast<int>(counted));
}

TEST(CertifyGravity, CollisionsOfTheExactGasAreProved) {
  const ProvedRuns runs = proved_of_exact_runs(600, 900, draw_falling, [](const Drawn& d) { return wide_run(d); });
  EXPECT_GE(runs.proved, runs.all * 9 / 10);
  EXPECT_GE(runs.all, 150U);
}

TEST(CertifyGravity, ARunThatIsWrongInOneCollisionIsNeverProved) {
  std::uint64_t mutants = 0;
  for (std::uint64_t number = 0; number < 300; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_falling(number);
    const WideRun run = wide_run(d);
    if (!run.ended || run.gas.tied || run.collisions.empty()) continue;
    WrongRuns wrong(d, run.collisions, 6, number);
    for (std::size_t k = 0; k < run.collisions.size(); ++k) wrong.refuse_dropped(k);
    for (std::uint64_t salt = 0; salt < 4; ++salt) wrong.refuse_invented(salt), wrong.refuse_late(salt);
    mutants += wrong.refused();
  }
  EXPECT_GE(mutants, 2000U);
}

TEST(CertifyGravity, EveryStateInTheBallsOfTheStartStaysInThem) {
  std::uint64_t counted = 0, on_walls = 0;
  for (std::uint64_t number = 0; number < 250; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_falling(number);
    const WideRun run = wide_run(off_the_middle(converted<bin_float>(gas_of(d)), number));
    Checker<B> checker(wide_particles(d), law_of(d));
    if (!run.ended || !proved(checker, run.collisions)) continue;
    ++counted;
    expect_proved(checker, d, run.gas);
    for (const auto& wall : run.gas.walls) on_walls += wall ? wall->collisions : 0;
  }
  EXPECT_GE(counted, 100U);
  EXPECT_GE(on_walls, 200U);
}

// ---- single particles, by hand

std::shared_ptr<const Particles<B>> thrown(const std::vector<B>& x, const std::vector<B>& v, double acceleration,
                                           std::optional<Wall<B>> left, std::optional<Wall<B>> right) {
  return std::make_shared<Walled<B>>(std::make_shared<List<B>>(x, v), std::move(left), std::move(right),
                                     B(acceleration));
}
Wall<B> wall_at(double place, double restitution = 1) { return {.position = B(place), .restitution = B(restitution)}; }
CertainLaw<B> elastic() {
  CertainLaw<B> law;
  law.elastic = true;
  return law;
}

// From the height 1 with the acceleration 2: at the floor at t = 1, 3, 5, ..., sums of n terms, each rounded by 2^-104
// t; and a term is as uncertain as the speed 2, which does not change.
TEST(CertifyGravity, ABouncingBallIsKnownUpToTheRoundingOfSums) {
  Checker<B> checker(thrown({B(1)}, {B(0)}, -2, wall_at(0), {}), elastic());
  for (int n = 0; n < 5000; ++n) {
    ASSERT_FALSE(checker.collision(-1, 0));
    const CertainState<B> now = checker.state_now();
    ASSERT_TRUE(holds(now.time, Rational(2 * n + 1)) && holds(now.closing, Rational(2)));
    ASSERT_LT(now.time.radius(), (2 * n + 1) * (n + 8) * 0x1p-102);
  }
}
// Two that exchange their lines are two such balls.
TEST(CertifyGravity, AnElasticColumnIsKnownUpToTheRoundingOfSums) {
  const auto particles = [](auto number) {
    using T = decltype(number);
    return std::make_shared<Walled<T>>(
        std::make_shared<List<T>>(std::vector<T>{T(1), T(2)}, std::vector<T>{T(0), T(T(5) / T(8))}), Wall<T>{T(0)},
        std::nullopt, T(-2));
  };
  Simulation run(Inelastic<double>(1), GapChain<double, IndividualMasses<double>, Gravity<double>>(particles(0.), 0.));
  Collisions collisions;
  run.advance(1000., [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
  ASSERT_GT(collisions.size(), 1000U);
  Checker<B> checker(particles(B(0)), elastic());
  ASSERT_FALSE(checker.collisions(collisions));
  const CertainState<B> end = checker.state_at(B(1000));
  ASSERT_FALSE(end.doubt);
  EXPECT_LT(end.widest, -20);
  EXPECT_TRUE(is_finite(end.energy) && end.energy.radius() < 1e-20);
}

// Thrown from 0 at a ceiling at 1 under the acceleration -1/2, it reaches it if v > 1, the later the slower.
std::optional<Doubt<B>> end_of(Checker<B>& checker, const Collisions& collisions, double time) {
  for (const auto& [left, right] : collisions)
    if (auto doubt = checker.collision(left, right)) return doubt;
  return checker.state_at(B(time)).doubt;
}
TEST(CertifyGravity, AParticleThatTouchesACeilingOnItsFlightIsRefuted) {
  const auto without = [](const B& v, double until_time) {
    Checker<B> checker(thrown({B(0)}, {v}, -0.5, {}, wall_at(1)), elastic());
    return end_of(checker, {}, until_time);
  };
  EXPECT_FALSE(without(B(0.875), 8));  // turns back below it
  EXPECT_FALSE(without(B(-0.5), 8));
  EXPECT_FALSE(without(B(1.5), 0.25));  // is not there yet
  const auto touched = without(B(1.5), 8);
  ASSERT_TRUE(touched);
  EXPECT_EQ(touched->check, Check::turns);
  EXPECT_TRUE(touched->refuted);
  EXPECT_EQ(touched->right, 1);
  // By 1e-30 and by 1e-25 of the speed: open, and certain.
  EXPECT_FALSE(without(B(double_double(1) - double_double(1e-25), 0), 8));
  EXPECT_TRUE(without(B(double_double(1) + double_double(1e-25), 0), 8)->refuted);
  ASSERT_TRUE(without(B(double_double(1), 1e-30), 8));
  EXPECT_FALSE(without(B(double_double(1), 1e-30), 8)->refuted);
  EXPECT_TRUE(without(B(1), 8)) << "a touch";
  // In the mirror.
  Checker<B> mirrored(thrown({B(0)}, {B(-1.5)}, 0.5, wall_at(-1), {}), elastic());
  const auto left = end_of(mirrored, {}, 8);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->check, Check::turns);
  EXPECT_EQ(left->left, -1);
}
TEST(CertifyGravity, OnlyTheFirstTimeAtACeilingIsACollision) {
  const auto with = [](const B& v) {
    Checker<B> checker(thrown({B(0)}, {v}, -0.5, {}, wall_at(1)), elastic());
    auto doubt = checker.collision(0, 1);
    if (!doubt) {  // 1 = v t - t^2/4
      const bin_float speed = bin_float(v.middle().high()) + bin_float(v.middle().low()),
                      time = 2 * (speed - sqrt(bin_float(speed * speed - 1)));
      EXPECT_TRUE(holds_wide(checker.state_now().time, time));
    }
    return doubt;
  };
  EXPECT_FALSE(with(B(1.5)));
  EXPECT_FALSE(with(B(1.25)));
  EXPECT_FALSE(with(B(double_double(1) + double_double(1e-25), 0)));
  const auto below = with(B(0.875));
  ASSERT_TRUE(below);
  EXPECT_EQ(below->check, Check::reaches);
  EXPECT_TRUE(below->refuted);
  const auto open = with(B(double_double(1), 1e-30));
  ASSERT_TRUE(open);
  EXPECT_EQ(open->check, Check::reaches);
  EXPECT_FALSE(open->refuted);
}
// The missing collision with the ceiling is found at the next one of the particle, on the floor or with another one.
TEST(CertifyGravity, ATouchIsFoundAtTheNextCollision) {
  const auto alone = thrown({B(0.5)}, {B(1.5)}, -0.5, wall_at(0), wall_at(1));
  Checker<B> on_floor(alone, elastic());
  const auto doubt = on_floor.collision(-1, 0);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->check, Check::turns);
  EXPECT_TRUE(doubt->refuted);
  Checker<B> right(alone, elastic());
  EXPECT_FALSE(end_of(right, {{0, 1}, {-1, 0}}, 1.5));

  const auto two = thrown({B(0), B(0.5)}, {B(0), B(1.5)}, -0.5, {}, wall_at(1));
  Checker<B> between(two, elastic());
  EXPECT_TRUE(between.collision(0, 1)) << "they part";
  const auto three = thrown({B(0), B(0.5)}, {B(1), B(1.0)}, -0.5, {}, wall_at(1));
  Checker<B> pushed(three, elastic());
  EXPECT_TRUE(pushed.collision(0, 1)) << "neither approaches";
  // The lower one comes from below while the upper one has touched the ceiling and falls.
  const auto late = thrown({B(-2), B(0.5)}, {B(1.75), B(1.5)}, -0.5, {}, wall_at(1));
  Checker<B> late_checker(late, elastic());
  const auto found = late_checker.collision(0, 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->check, Check::turns);
  EXPECT_EQ(found->left, 1);
  EXPECT_EQ(found->right, 2);
}

// The gap 1 - 2 t + 3 t^2/4 closes at t = 2/3, still closing there, and turns at t = 4/3.
TEST(CertifyGravity, AGapThatHasClosedIsNotOpen) {
  const auto closes = [](double before, double until_time, double gap = 1) {
    return CertainApproach<B>{B(gap), B(2), B(-1.5)}.closes(B(before), B(until_time));
  };
  EXPECT_FALSE(closes(0, 0.625));
  for (const double time : {0.75, 1., 1.25, 1.375, 3.}) {
    const auto open = closes(0, time);
    ASSERT_TRUE(open) << time;
    EXPECT_TRUE(open->refuted) << time;
  }
  EXPECT_FALSE(closes(0, 3, 1.375)) << "4/3 is enough";
  EXPECT_FALSE(closes(2.5, 3)) << "opens after the other root, at t = 2";
}
// The new line goes through the place of the wall at any time at which the collision can have been.
TEST(CertifyGravity, ALineFromAWallHoldsAllThatItsTimeMayBe) {
  const double radius = 0x1p-12, acceleration = -0.5, of_wall = 0.25;
  for (const double restitution : {0., 0.5}) {
    const CertainLaw<B> law = elastic();
    Wall<B> wall = wall_at(1, restitution);
    wall.speed = B(of_wall);
    Motion<B> motion(thrown({B(0)}, {B(1)}, acceleration, {}, wall), law);
    CertainWalls<B> walls(motion.lines.particles());
    ASSERT_FALSE(walls.strike(motion, {1, 0, B(2) + B(double_double(0), radius), B(0.5)}, false));
    for (const double off : {-radius, 0., radius}) {
      const Rational time = Rational(2) + exactly(off), a = exactly(acceleration), v = exactly(of_wall);
      const Rational after = v - exactly(0.5 * restitution) - a * time;  // as seen by one who falls
      EXPECT_TRUE(holds(motion.lines[0].velocity, after));
      EXPECT_TRUE(holds(motion.lines[0].place, 1 + v * time - a * time * time / 2 - after * exactly(off)));
    }
  }
}

// Of rows few particles are held; the others fall as well.
TEST(CertifyGravity, ParticlesThatAreNotHeldFallToo) {
  const auto rows = std::make_shared<Rows<B>>(Row<B>{20, B(1), B(1)}, Row<B>{10, B(-0.5), B(1)}, std::nullopt,
                                              [](ParticleIndex) { return std::int64_t{0}; });
  const Checker<B> checker(std::make_shared<Walled<B>>(rows, std::nullopt, std::nullopt, B(0.75)), elastic());
  const CertainState<B> now = checker.state_at(B(0.25));
  ASSERT_FALSE(now.doubt);
  EXPECT_LT(now.sizes.particles, 30U);
  EXPECT_TRUE(holds(now.energy, exactly(20 * 1.1875 * 1.1875 / 2 + 10 * 0.3125 * 0.3125 / 2)));
  EXPECT_LT(now.energy.radius(), 1e-28);
}
TEST(CertifyGravity, OverAFloorTheyAreNeverOver) {
  const auto over = [](const std::optional<Wall<B>>& left, const std::optional<Wall<B>>& right) {
    return Checker<B>(thrown({B(0.25), B(0.5)}, {B(1), B(2)}, -0.5, left, right), elastic()).state_at(B(0)).over;
  };
  EXPECT_TRUE(over({}, {}));
  EXPECT_FALSE(over(wall_at(0), {}));
}

// Below the cut-off a floor is elastic, within the contact time too; above it is not. Which is which must be certain.
TEST(CertifyGravity, ThresholdsOfTheLawHoldOnFloors) {
  const auto particles = thrown({B(1)}, {B(0)}, -2, wall_at(0, 0.5), {});  // meets it at 2, 1, 1/2, ...
  CertainLaw<B> law = elastic();
  law.cutoff = B(0.75);
  Checker<B> cut_off(particles, law);
  const double times[] = {1, 2, 2.5, 3, 3.5};
  for (const double time : times) {
    ASSERT_FALSE(cut_off.collision(-1, 0));
    EXPECT_TRUE(holds(cut_off.state_now().time, exactly(time)));
  }
  EXPECT_EQ(cut_off.proved().below_cutoff, 3U);
  EXPECT_TRUE(holds(cut_off.state_now().walls[0].dissipated, exactly(1.875)));
  law.cutoff = B(1);
  Checker<B> open(particles, law);
  EXPECT_FALSE(open.collision(-1, 0));
  const auto doubt = open.collision(-1, 0);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->check, Check::side);
  law.cutoff.reset(), law.contact_time = B(0.75);
  Checker<B> brief(particles, law);
  const double elastic_from[] = {1, 2, 2.5, 3};  // 1/2 after the second one
  for (const double time : elastic_from) {
    ASSERT_FALSE(brief.collision(-1, 0));
    EXPECT_TRUE(holds(brief.state_now().time, exactly(time)));
  }
  EXPECT_EQ(brief.proved().below_cutoff, 2U);
}

}  // namespace certify_gravity_test
