// The checker of proofs, scene by scene: what is open and what is refuted, with walls too; collisions of long runs side
// by side are those of one by one; the averaged errors of a restitution that depends on the speed; exp(-x^s) lies in
// its ball. With walls under gravity, of single particles by hand: what is open and what is refuted, above all of one
// that touches a ceiling on its flight; a bouncing ball is known up to the rounding of sums. (Scenes drawn at random:
// certify_drawn_test.cpp.)
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/drawn_scenes.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::certify_test {

using namespace cradle::test::drawn;

CertainLaw<B> with_restitution(const char* restitution, double cutoff = 0) {
  CertainLaw<B> law;
  law.restitution = from_text<B>(restitution);
  law.elastic = std::string(restitution) == "1";
  if (cutoff > 0) law.cutoff = B(cutoff);
  return law;
}

// Elastic particles of nearly equal masses that all approach each other, and so had no collisions before, make n - 1,
// n (n - 1)/2 or (n + 1) n (n - 1)/6 collisions in all (A. Knauf and M. Stepan, arXiv 1109.6242); none is left.
TEST(Certify, ElasticParticlesOfNearlyEqualMassesMakeAsManyCollisionsAsTheyCan) {
  using Texts = std::vector<std::string>;
  const auto proved_of = [](const Texts& x, const Texts& v, const Texts& m) -> std::uint64_t {
    const auto particles = [&]<class T>(T) { return list(numbers<T>(x), numbers<T>(v), numbers<T>(m)); };
    const Collisions collisions = made_by(mass_run<double>(particles(0.), Inelastic<double>(1)), 100);
    Checker<B> checker(particles(B()), CertainLaw<B>());
    EXPECT_FALSE(checker.state_at(B(0)).over);
    EXPECT_FALSE(checker.collisions(collisions));
    const CertainState<B> end = checker.state_at(B(100));
    EXPECT_FALSE(end.doubt);
    EXPECT_TRUE(end.over);
    return checker.proved().collisions;
  };
  EXPECT_EQ(proved_of({"0.617", "0.927", "0.953"}, {"-0.6", "-0.914", "-0.929"}, {"1", "1.05", "0.99"}), 2U);
  EXPECT_EQ(proved_of({"-0.81", "-0.54", "0.11"}, {"0.78", "0.57", "-0.1"}, {"1", "1", "1.01"}), 3U);
  EXPECT_EQ(proved_of({"-0.753", "-0.749", "0.877"}, {"0.787", "0.774", "-0.9"}, {"1", "0.95", "1"}), 4U);
  EXPECT_EQ(proved_of({"-1.641", "-0.559", "-0.178", "0.603"}, {"0.973", "0.9415", "0.9339", "-0.3165"},
                      {"0.98", "1.07", "1.1", "1.1"}),
            3U);
  EXPECT_EQ(proved_of({"-0.818", "-0.4", "-0.325", "0.141"}, {"0.8", "0.39", "0.3", "-0.134"}, {"1", "1", "1", "1.02"}),
            6U);
  EXPECT_EQ(proved_of({"-1.000002459", "-0.999374889", "-0.972827509", "1"}, {"1", "0.999359194", "0.97232206", "-1"},
                      {"0.9171516", "0.9097226", "0.966177", "1.0627597"}),
            10U);
}

TEST(Certify, ATieIsOpenAndNamesTheParticles) {
  // The middle one is hit from both sides at once.
  Checker<B> checker(list<B>({B(-1), B(0), B(1)}, {B(1), B(0), B(-1)}), with_restitution("0.9"));
  EXPECT_FALSE(checker.begin());
  EXPECT_FALSE(checker.collision(0, 1));
  const auto doubt = checker.collision(1, 2);
  ASSERT_TRUE(is_doubt(doubt, Check::later, false));
  EXPECT_EQ(doubt->left, 1);
  EXPECT_EQ(doubt->right, 2);
}

TEST(Certify, CollisionsThatShareNoParticleMayComeInAnyOrder) {
  // Two pairs that meet at one moment, far from each other.
  const auto particles = list<B>({B(-11), B(-9), B(9), B(11)}, {B(1), B(-1), B(1), B(-1)});
  for (const Collisions& collisions : {Collisions{{0, 1}, {2, 3}}, Collisions{{2, 3}, {0, 1}}}) {
    Checker<B> checker(particles, with_restitution("0.9"));
    EXPECT_TRUE(proved(checker, collisions));
    EXPECT_EQ(checker.proved().in_doubles, 2U);
  }
}

TEST(Certify, ParticlesThatAreNotInOrderForSureAreNoStart) {
  EXPECT_FALSE(Checker<B>(list<B>({B(0), B(1)}, {B(0), B(0)}), CertainLaw<B>()).begin());
  EXPECT_THROW(List<B>({B(double_double(0), 1), B(double_double(1), 1)}, {B(0), B(0)}), std::invalid_argument);
}

// ---- walls

// By the line that it had before, particle 0 would have met the wall at t = 2, and this is later, at t = 4.
TEST(CertifyWalls, ACollisionWithAWallBeforeTheLastOneOfItsParticleIsRefuted) {
  const auto particles = list<B>({B(1), B(3)}, {B(-1), B(double_double(-1.5), 0)});
  Checker<B> checker(std::make_shared<Walled<B>>(particles, Wall<B>{B(0)}, std::nullopt), CertainLaw<B>());
  ASSERT_FALSE(checker.collision(0, 1));
  EXPECT_TRUE(is_doubt(checker.collision(-1, 0), Check::later, true));
}

TEST(CertifyWalls, WhereNothingApproachesAnyMoreTheyAreOver) {
  const auto over = [](const std::vector<int>& v, const std::vector<int>& walls) {
    std::vector<B> x, speeds;
    for (const int speed : v) x.emplace_back(static_cast<int>(x.size()) + 1), speeds.emplace_back(speed);
    std::optional<Wall<B>> left, right;
    if (!walls.empty()) left = Wall<B>{B(0), B(walls.front())};
    if (walls.size() > 1) right = Wall<B>{B(100), B(walls.back())};
    Checker<B> checker(std::make_shared<Walled<B>>(list(x, speeds), left, right), CertainLaw<B>());
    return checker.state_at(B(0)).over;
  };
  EXPECT_TRUE(over({-1, 0, 0, 2}, {}));
  EXPECT_FALSE(over({-1, 1, 0, 2}, {}));
  EXPECT_FALSE(over({-1, 0, 2}, {0}));
  EXPECT_TRUE(over({-1, 0, 2}, {-1}));
  EXPECT_TRUE(over({0, 1}, {0}));
  EXPECT_FALSE(over({0, 1}, {0, 0}));
  EXPECT_TRUE(over({0, 1}, {0, 1}));
}

TEST(CertifyWalls, AMassBetweenTwoDoublesHasNoCertainRandomSpeed) {
  const auto doubt = [](const B& mass) {
    Wall<B> wall{B(0)};
    wall.temperature = 1;
    Checker<B> checker(std::make_shared<Walled<B>>(list<B>({B(1)}, {B(-1)}, {mass}), wall, std::nullopt),
                       CertainLaw<B>());
    return checker.collision(-1, 0);
  };
  EXPECT_FALSE(doubt(B(1)));
  EXPECT_FALSE(doubt(from_text<B>("0.1")));
  EXPECT_TRUE(is_doubt(doubt(B(double_double(1) + double_double(0x1p-53), 1e-30)), Check::side, false));
}

// ---- walls under gravity

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

// ---- collisions side by side

// One checker is given collisions one by one, another one in pieces: all that they know is the same, to the bit.
struct Known {
  std::uint64_t collisions, in_doubles, below_cutoff;
  std::vector<double> numbers;
  friend bool operator==(const Known&, const Known&) = default;
};
void add(std::vector<double>& to, const B& x) {
  to.insert(to.end(), {x.middle().high(), x.middle().low(), x.radius()});
}
Known known(const Checker<B>& checker) {
  Known all{checker.proved().collisions, checker.proved().in_doubles, checker.proved().below_cutoff, {}};
  checker.for_each(B(0),
                   [&](ParticleIndex, const B&, const B& x, const B& v) { add(all.numbers, x), add(all.numbers, v); });
  const auto last = checker.state_now();
  add(all.numbers, last.time), add(all.numbers, last.closing), add(all.numbers, last.energy);
  for (const auto& account : last.walls) add(all.numbers, account.given);
  return all;
}

void compare_side_by_side(const std::shared_ptr<const Particles<B>>& particles, const CertainLaw<B>& law,
                          const Collisions& collisions, std::size_t piece, bool proves) {
  Checker<B> one(particles, law), many(particles, law);
  std::optional<Doubt<B>> doubt;
  std::optional<DoubtAt<B>> at;
  for (std::size_t k = 0; k < collisions.size() && !doubt; k += piece) {
    const std::span<const Checker<B>::Pair> some =
        std::span(collisions).subspan(k, std::min(piece, collisions.size() - k));
    at = many.collisions(some);
    std::size_t number = 0;
    for (; number < some.size() && !doubt; ++number) doubt = one.collision(some[number].first, some[number].second);
    ASSERT_EQ(doubt.has_value(), at.has_value());
    if (!doubt) {
      if (k % 97 < piece || k + piece >= collisions.size()) {
        ASSERT_EQ(known(one), known(many));
      }
      continue;
    }
    EXPECT_EQ(at->number + 1, number);
    EXPECT_EQ(at->doubt.check, doubt->check);
    EXPECT_EQ(at->doubt.refuted, doubt->refuted);
    EXPECT_EQ(at->doubt.left, doubt->left);
    EXPECT_EQ(at->doubt.right, doubt->right);
    std::vector<double> quantities, of_one;
    add(quantities, at->doubt.first), add(quantities, at->doubt.second);
    add(of_one, doubt->first), add(of_one, doubt->second);
    EXPECT_EQ(quantities, of_one);
    EXPECT_EQ(many.proved().collisions, one.proved().collisions);
    EXPECT_EQ(many.proved().in_doubles, one.proved().in_doubles);
    EXPECT_EQ(many.proved().below_cutoff, one.proved().below_cutoff);
  }
  EXPECT_EQ(doubt.has_value(), !proves);
}

TEST(Certify, SideBySideCollisionsOfDrawnScenesAreThoseOfOneByOne) {
  std::uint64_t on_walls = 0;
  for (const auto draw_scene :
       {draw, draw_by<GasLaw::sticky>, draw_wet, draw_with_walls, draw_speed_dependent, draw_falling})
    for (std::uint64_t number = 0; number < 500; ++number) {
      SCOPED_TRACE(number);
      Drawn d = draw_scene(number);
      if (d.walls[0] || d.walls[1]) d.masses.assign(d.masses.size(), 64);
      const Collisions collisions = made(d);
      Checker<B> checker(particles_of<B>(d), law_of(d));
      const bool proves = proved_in_order(checker, collisions);
      compare_side_by_side(particles_of<B>(d), law_of(d), collisions, 1 + number % 50, proves);
      if (!proves) continue;
      for (const auto& account : checker.state_at(B(until)).walls) on_walls += account.collisions;
    }
  EXPECT_GE(on_walls, 1500U);
}

struct Proposed {
  std::shared_ptr<const Particles<B>> particles;
  CertainLaw<B> law;
  Collisions collisions;
};
Proposed propose(bool ring, ParticleIndex count, const char* restitution, double cutoff, double end) {
  const auto particles = [&]<class T>(std::type_identity<T>) -> std::shared_ptr<const Particles<T>> {
    if (ring)
      return std::make_shared<Ring<T>>(count, T(count), T(1), gaussian_velocity(5, 0), uniform_displacement(0.3, 5, 0));
    return std::make_shared<Rows<T>>(symmetric_rows<T>(count, T(1) / T(2), T(1), uniform_displacement(0.1, 3, 0)));
  };
  return {particles(std::type_identity<B>{}), with_restitution(restitution, cutoff),
          made_by(gap_run(particles(std::type_identity<double>{}), Inelastic<double>(std::stod(restitution), cutoff)),
                  end)};
}
std::vector<Proposed> proposals() {
  return {propose(false, 200, "0.97", 0.01, 150), propose(false, 200, "0.9", 0.25, 120),
          propose(true, 300, "0.9", 0.5, 20), propose(true, 150, "1", 0, 10), propose(true, 60, "0.3", 0.125, 60)};
}

TEST(Certify, SideBySideCollisionsHaveTheBitsOfOneByOne) {
  std::uint64_t below = 0;
  for (const Proposed& run : proposals()) {
    ASSERT_GT(run.collisions.size(), 500U);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{500}, run.collisions.size()})
      compare_side_by_side(run.particles, run.law, run.collisions, piece, true);
    Checker<B> checker(run.particles, run.law);
    ASSERT_FALSE(checker.collisions(run.collisions));
    EXPECT_GT(checker.proved().in_doubles, run.collisions.size() * 9 / 10);
    below += checker.proved().below_cutoff;
  }
  EXPECT_GT(below, 1000U);
}

TEST(Certify, SideBySideCollisionsAreInDoubtWhereTheyAreOneByOne) {
  std::uint64_t mutants = 0;
  for (const Proposed& run : proposals()) {
    for (std::uint64_t number = 0; number < 40; ++number) {
      SCOPED_TRACE(number);
      const auto pick = [&](std::uint64_t salt, std::size_t of) { return random_bits(9, number, salt) % of; };
      Collisions changed = run.collisions;
      for (std::uint64_t error = 0; error <= number % 3; ++error) {  // the first of several is the one in doubt
        const auto at = changed.begin() + static_cast<std::ptrdiff_t>(pick(error, changed.size() - 60));
        const auto count = run.particles->count();
        const auto left = static_cast<ParticleIndex>(pick(10 + error, static_cast<std::size_t>(count - 1)));
        if (number % 4 == 0) changed.erase(at);
        if (number % 4 == 1) changed.insert(at, {left, left + 1});
        if (number % 4 == 2) changed.insert(at, {left, left + 2});
        if (number % 4 == 3) exchange_with_next(changed, pick(error, changed.size() - 60));
      }
      compare_side_by_side(run.particles, run.law, changed, 1 + pick(20, 3000), false);
      ++mutants;
    }
  }
  EXPECT_EQ(mutants, 200U);
}

TEST(Certify, SideBySideASpeedThatMayBeZeroOrAtTheCutoffIsOpen) {
  const auto compare = [](const B& first, const B& second, double cutoff) {
    const auto particles = list<B>({B(0), B(1), B(10), B(11)}, {first, B(0), second, B(0)});
    compare_side_by_side(particles, with_restitution("0.9", cutoff), {{0, 1}, {2, 3}}, 2, false);
  };
  compare(B(double_double(1e-30), 1e-29), B(1), 0);
  compare(B(1), B(2), 1);
}

// Without the circumference the time of the first collision would be (0.1 - 0.9)/6: before the start, but later than
// the time of "no collision yet".
TEST(Certify, SideBySideACollisionOverTheSeamOfAShortRingIsComputedAlone) {
  const std::vector<B> x{from_text<B>("0.1"), from_text<B>("0.6"), from_text<B>("0.9")}, v{B(-3), B(0), B(3)};
  compare_side_by_side(std::make_shared<List<B>>(x, v, std::vector<B>{}, B(1)), with_restitution("0.9"),
                       {{2, 0}, {1, 2}, {0, 1}}, 3, true);
}

// ---- restitutions of the closing speed

// A shock of identical particles: the errors of velocities are averaged, sigma = 4 and eps = 0.5 (certain_law.hpp).
// They stay within the roundings of a collision, 2^-95 or so, times the collisions of a particle.
TEST(CertifyRestitutionOfSpeed, ErrorsOfVelocitiesAreAveraged) {
  const auto particles = []<class T>(std::type_identity<T>) {
    std::vector<T> x, v;
    for (int k = 0; k < 60; ++k) {
      x.push_back(T(k + static_cast<double>(random_bits(31, 0, static_cast<std::uint64_t>(k)) >> 40) * 0x1p-26));
      v.push_back(T(k < 30 ? 1 : -1));
    }
    return list(x, v);
  };
  const Collisions collisions =
      made_by(Simulation(SpeedDependent<double>(0.5, 0.25, 4.),
                         GapChain<double, IndividualMasses<double>>(particles(std::type_identity<double>{}), 0.)),
              60);
  CertainLaw<B> law = with_restitution("0.5", 0.25);
  law.cutoff_exponent = B(4);
  Checker<B> checker(particles(std::type_identity<B>{}), law);
  ASSERT_FALSE(checker.collisions(collisions));
  ASSERT_GT(collisions.size(), 1000U);
  ASSERT_FALSE(checker.state_at(B(60)).doubt);
  checker.for_each(B(60), [&](ParticleIndex, const B&, const B&, const B& velocity) {
    EXPECT_LT(velocity.radius(), static_cast<double>(collisions.size()) * 0x1p-95);
  });
}

template <class M> Rational exact_middle(const Ball<M>& x) {
  const double high = to_double(x.middle()), low = to_double(M(x.middle() - M(high))),
               rest = to_double(M(x.middle() - M(high) - M(low)));
  return exactly(high) + exactly(low) + exactly(rest);  // what is left is below 2^-150
}
template <class M> void expect_fall(double most_off) {
  for (std::uint64_t number = 0; number < 400; ++number) {
    SCOPED_TRACE(number);
    const char* const exponents[] = {"1", "4", "0.5", "2.5", "1.0", "64", "65", "0.01"};
    const char* exponent = exponents[number % 8];
    const double near = std::ldexp(1 + static_cast<double>(random_bits(3, number, 0) >> 11) * 0x1p-53,
                                   static_cast<int>(random_bits(3, number, 1) % 16) - 10);
    const double width = number % 3 == 0 ? 0 : near * std::ldexp(1., -static_cast<int>(random_bits(3, number, 2) % 80));
    const Ball<M> x(M(near), width);
    const auto at = CertainFall<Ball<M>>(from_text<Ball<M>>(exponent))(x);
    for (const double end : {-1., 0., 0.7, 1.}) {
      const bin_float of = bin_float(near) + bin_float(width) * bin_float(end);
      if (!(of > 0) || !is_positive(x)) continue;
      const bin_float y = pow(of, decimal<bin_float>(exponent)), fall = exp(-y), weighted = y * fall;
      const auto within = [](const Ball<M>& ball, const bin_float& value) {
        const Rational off = abs(Rational(exact_middle(ball) - in_rationals(value)));
        return !(ball.radius() < 1e300) || off <= exactly(static_cast<double>(ball.radius())) + exactly(0x1p-148);
      };
      EXPECT_TRUE(within(at.fall, fall)) << near << " + " << width << ", " << exponent;
      EXPECT_TRUE(within(at.weighted, weighted)) << near << " + " << width << ", " << exponent;
    }
    if (width == 0) {
      EXPECT_LT(static_cast<double>(at.fall.radius()), most_off) << near << ", " << exponent;
    }
  }
}
// Some 40 operations, doubled by up to 10 squares of numbers below 1: 2^-104 of double-double times 2^6 2^10.
TEST(CertifyRestitutionOfSpeed, ExponentialsOfPowersAreEnclosed) {
  expect_fall<double_double>(0x1p-85);
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(50));
  expect_fall<Mpfr<4>>(1e-40);
#endif
}

}  // namespace cradle::test::certify_test
