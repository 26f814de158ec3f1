// Proofs with walls under gravity, of single particles by hand: what is open and what is refuted, above all of one that
// touches a ceiling on its flight; a bouncing ball is known up to the rounding of sums. (Scenes drawn at random:
// certify_drawn_test.cpp.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"

namespace cradle::test::certify_gravity_test {

using namespace cradle::test::drawn;

std::shared_ptr<const Particles<B>> thrown(const std::vector<B>& x, const std::vector<B>& v, double acceleration,
                                           std::optional<Wall<B>> left, std::optional<Wall<B>> right) {
  return std::make_shared<Walled<B>>(list(x, v), std::move(left), std::move(right), B(acceleration));
}
Wall<B> wall_at(double place, double restitution = 1) { return {.position = B(place), .restitution = B(restitution)}; }
const CertainLaw<B> elastic{.elastic = true};

// From the height 1 with the acceleration 2: at the floor at t = 1, 3, 5, ..., sums of n terms, each rounded by 2^-104
// t; and a term is as uncertain as the speed 2, which does not change.
TEST(CertifyGravity, ABouncingBallIsKnownUpToTheRoundingOfSums) {
  Checker<B> checker(thrown({B(1)}, {B(0)}, -2, wall_at(0), {}), elastic);
  for (int n = 0; n < 5000; ++n) {
    ASSERT_FALSE(checker.collision(-1, 0));
    const CertainState<B> now = checker.state_now();
    ASSERT_TRUE(holds(now.time, Rational(2 * n + 1)) && holds(now.closing, Rational(2)));
    ASSERT_LT(now.time.radius(), (2 * n + 1) * (n + 8) * 0x1p-102);
  }
}
// Two that exchange their lines are two such balls.
TEST(CertifyGravity, AnElasticColumnIsKnownUpToTheRoundingOfSums) {
  const auto particles = []<class T>(T) {
    return std::make_shared<Walled<T>>(list<T>({T(1), T(2)}, {T(0), T(T(5) / T(8))}), Wall<T>{T(0)}, std::nullopt,
                                       T(-2));
  };
  const Collisions collisions = made_by(mass_run<double>(particles(0.), Inelastic<double>(1)), 1000);
  ASSERT_GT(collisions.size(), 1000U);
  Checker<B> checker(particles(B(0)), elastic);
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
    Checker<B> checker(thrown({B(0)}, {v}, -0.5, {}, wall_at(1)), elastic);
    return end_of(checker, {}, until_time);
  };
  EXPECT_FALSE(without(B(0.875), 8));  // turns back below it
  EXPECT_FALSE(without(B(-0.5), 8));
  EXPECT_FALSE(without(B(1.5), 0.25));  // is not there yet
  const auto touched = without(B(1.5), 8);
  ASSERT_TRUE(is_doubt(touched, Check::turns, true));
  EXPECT_EQ(touched->right, 1);
  // By 1e-30 and by 1e-25 of the speed: open, and certain.
  EXPECT_FALSE(without(B(double_double(1) - double_double(1e-25), 0), 8));
  EXPECT_TRUE(is_doubt(without(B(double_double(1) + double_double(1e-25), 0), 8), Check::turns, true));
  EXPECT_TRUE(is_doubt(without(B(double_double(1), 1e-30), 8), Check::turns, false));
  EXPECT_TRUE(without(B(1), 8)) << "a touch";
  // In the mirror.
  Checker<B> mirrored(thrown({B(0)}, {B(-1.5)}, 0.5, wall_at(-1), {}), elastic);
  const auto left = end_of(mirrored, {}, 8);
  ASSERT_TRUE(is_doubt(left, Check::turns, true));
  EXPECT_EQ(left->left, -1);
}
TEST(CertifyGravity, OnlyTheFirstTimeAtACeilingIsACollision) {
  const auto with = [](const B& v) {
    Checker<B> checker(thrown({B(0)}, {v}, -0.5, {}, wall_at(1)), elastic);
    auto doubt = checker.collision(0, 1);
    if (!doubt) {  // 1 = v t - t^2/4
      const bin_float speed = bin_float(v.middle().high()) + bin_float(v.middle().low()),
                      time = 2 * (speed - sqrt(bin_float(speed * speed - 1)));
      EXPECT_TRUE(holds(checker.state_now().time, time));
    }
    return doubt;
  };
  EXPECT_FALSE(with(B(1.5)));
  EXPECT_FALSE(with(B(1.25)));
  EXPECT_FALSE(with(B(double_double(1) + double_double(1e-25), 0)));
  EXPECT_TRUE(is_doubt(with(B(0.875)), Check::reaches, true));
  EXPECT_TRUE(is_doubt(with(B(double_double(1), 1e-30)), Check::reaches, false));
}
// The missing collision with the ceiling is found at the next one of the particle, on the floor or with another one.
TEST(CertifyGravity, ATouchIsFoundAtTheNextCollision) {
  const auto alone = thrown({B(0.5)}, {B(1.5)}, -0.5, wall_at(0), wall_at(1));
  Checker<B> on_floor(alone, elastic);
  EXPECT_TRUE(is_doubt(on_floor.collision(-1, 0), Check::turns, true));
  Checker<B> right(alone, elastic);
  EXPECT_FALSE(end_of(right, {{0, 1}, {-1, 0}}, 1.5));

  const auto of_two = [](const std::vector<B>& x, const std::vector<B>& v) {
    return Checker<B>(thrown(x, v, -0.5, {}, wall_at(1)), elastic).collision(0, 1);
  };
  EXPECT_TRUE(of_two({B(0), B(0.5)}, {B(0), B(1.5)})) << "they part";
  EXPECT_TRUE(of_two({B(0), B(0.5)}, {B(1), B(1.0)})) << "neither approaches";
  // The lower one comes from below while the upper one has touched the ceiling and falls.
  const auto found = of_two({B(-2), B(0.5)}, {B(1.75), B(1.5)});
  ASSERT_TRUE(is_doubt(found, Check::turns, true));
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
    Wall<B> wall = wall_at(1, restitution);
    wall.speed = B(of_wall);
    Motion<B> motion(thrown({B(0)}, {B(1)}, acceleration, {}, wall), elastic);
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
  const Checker<B> checker(std::make_shared<Walled<B>>(rows, std::nullopt, std::nullopt, B(0.75)), elastic);
  const CertainState<B> now = checker.state_at(B(0.25));
  ASSERT_FALSE(now.doubt);
  EXPECT_LT(now.sizes.particles, 30U);
  EXPECT_TRUE(holds(now.energy, exactly(20 * 1.1875 * 1.1875 / 2 + 10 * 0.3125 * 0.3125 / 2)));
  EXPECT_LT(now.energy.radius(), 1e-28);
}
TEST(CertifyGravity, OverAFloorTheyAreNeverOver) {
  const auto over = [](const std::optional<Wall<B>>& left, const std::optional<Wall<B>>& right) {
    return Checker<B>(thrown({B(0.25), B(0.5)}, {B(1), B(2)}, -0.5, left, right), elastic).state_at(B(0)).over;
  };
  EXPECT_TRUE(over({}, {}));
  EXPECT_FALSE(over(wall_at(0), {}));
}

// Below the cut-off a floor is elastic, within the contact time too; above it is not. Which is which must be certain.
TEST(CertifyGravity, ThresholdsOfTheLawHoldOnFloors) {
  // Meets the floor at speeds of 2, 1, 1/2, ..., as long as it is not elastic.
  const auto checker_of = [](std::optional<B> cutoff, std::optional<B> contact_time) {
    const CertainLaw<B> law{.elastic = true, .cutoff = cutoff, .contact_time = contact_time};
    return Checker<B>(thrown({B(1)}, {B(0)}, -2, wall_at(0, 0.5), {}), law);
  };
  const auto expect_collisions_at = [](Checker<B>& checker, const std::vector<double>& times, std::uint64_t below) {
    for (const double time : times) {
      ASSERT_FALSE(checker.collision(-1, 0));
      EXPECT_TRUE(holds(checker.state_now().time, exactly(time)));
    }
    EXPECT_EQ(checker.proved().below_cutoff, below);
  };
  Checker<B> cut_off = checker_of(B(0.75), {}), open = checker_of(B(1), {}), brief = checker_of({}, B(0.75));
  expect_collisions_at(cut_off, {1, 2, 2.5, 3, 3.5}, 3);
  EXPECT_TRUE(holds(cut_off.state_now().walls[0].dissipated, exactly(1.875)));
  EXPECT_FALSE(open.collision(-1, 0));
  EXPECT_TRUE(is_doubt(open.collision(-1, 0), Check::side, false));
  expect_collisions_at(brief, {1, 2, 2.5, 3}, 2);  // elastic from 1/2 after the second one on
}

}  // namespace cradle::test::certify_gravity_test
