// Proofs with walls, and with restitutions of the closing speed. Proves: what the checker says of collisions with walls
// at rest, in uniform motion, inelastic and thermal is what rationals give, accounts of walls included; what it says of
// r(w) is what 100 digits give; a run that is wrong in one collision is never proved; exp(-x^s) and shares that depend
// on a difference lie in their balls.
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/tests/precision/drawn_scenes.hpp"
#include "cradle/tests/precision/wrong_runs.hpp"
#ifdef CRADLE_WITH_MPFR
#include "cradle/precision/mpfr.hpp"
#endif

namespace certify_walls_test {

using namespace cradle;
using namespace cradle::test;
using namespace cradle::test::drawn;

void expect_account(const CertainAccount<B>& account, const GasWall<Rational>& wall) {
  EXPECT_EQ(account.collisions, wall.collisions);
  EXPECT_TRUE(holds(account.given, wall.given));
  EXPECT_TRUE(holds(account.momentum, wall.momentum));
  EXPECT_TRUE(holds(account.dissipated, wall.lost));
}

TEST(CertifyWalls, WhatIsProvedIsWhatRationalsGive) {
  std::uint64_t counted = 0, with_walls = 0;
  for (std::uint64_t number = 0; number < 350; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_with_walls(number);
    const ExactRun run = exact_run(d);
    if (!run.ended) continue;
    Checker<B> checker(particles_of<B>(d), law_of(d));
    const Collisions collisions = made(d);
    if (!proved(checker, collisions)) continue;
    ++counted;
    ASSERT_FALSE(run.tied);
    ASSERT_EQ(digest_of(collisions), run.digest);
    const CertainState<B> end = checker.state_at(B(until));
    EXPECT_TRUE(law_of(d).elastic || checker.proved().below_cutoff == run.below);
    EXPECT_TRUE(holds(end.energy, run.gas.energy()));
    ASSERT_EQ(end.front_left.has_value(), run.gas.outermost(true) != nullptr);
    if (end.front_left) {
      EXPECT_TRUE(holds(*end.front_left, run.gas.place(*run.gas.outermost(true))));
      EXPECT_TRUE(holds(*end.front_right, run.gas.place(*run.gas.outermost(false))));
    }
    std::size_t particles = 0;
    checker.for_each(B(until), [&](ParticleIndex particle, const B& m, const B& x, const B& v) {
      const auto& cell = run.gas.cell_of(particle);
      EXPECT_TRUE(holds(m, cell.m) && holds(x, run.gas.place(cell)) && holds(v, cell.v)) << particle;
      ++particles;
    });
    EXPECT_EQ(particles, d.gaps.size());
    for (std::size_t side = 0; side < 2; ++side) {
      if (!d.walls[side]) continue;
      expect_account(end.walls[side], *run.gas.walls[side]);
      with_walls += end.walls[side].collisions;
    }
  }
  EXPECT_GE(counted, 200U);
  EXPECT_GE(with_walls, 500U);
}

TEST(CertifyWalls, CollisionsOfTheExactGasAreProved) {
  const ProvedRuns runs = proved_of_exact_runs(350, 600, draw_with_walls, [](const Drawn& d) { return exact_run(d); });
  EXPECT_GE(runs.proved, runs.all * 9 / 10);
}

TEST(CertifyWalls, ARunThatIsWrongInOneCollisionIsNeverProved) {
  std::uint64_t mutants = 0;
  for (std::uint64_t number = 0; number < 250; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_with_walls(number);
    const ExactRun run = exact_run(d);
    if (!run.ended || run.tied || run.collisions.empty()) continue;
    WrongRuns wrong(d, run.collisions, 5, number);
    for (std::uint64_t salt = 0; salt < 3; ++salt) {
      wrong.refuse_dropped(wrong.pick(salt, run.collisions.size()));
      wrong.refuse_invented(salt);
      wrong.refuse_late(salt);
    }
    mutants += wrong.refused();
  }
  EXPECT_GE(mutants, 1000U);
}

TEST(CertifyWalls, SideBySideCollisionsAreThoseOfOneByOne) {
  std::uint64_t alone = 0;
  for (std::uint64_t number = 0; number < 400; ++number) {
    SCOPED_TRACE(number);
    Drawn d = draw_with_walls(number);
    for (int& mass : d.masses) mass = 64;
    const Collisions collisions = made(d);
    Checker<B> one(particles_of<B>(d), law_of(d)), many(particles_of<B>(d), law_of(d));
    std::size_t right = 0;
    while (right < collisions.size() && !one.collision(collisions[right].first, collisions[right].second)) ++right;
    const auto at = many.collisions(collisions);
    ASSERT_EQ(at.has_value(), right < collisions.size());
    EXPECT_EQ(many.proved().collisions, one.proved().collisions);
    EXPECT_EQ(many.proved().in_doubles, one.proved().in_doubles);
    if (at) {
      EXPECT_EQ(at->number, right);
      continue;
    }
    const auto same = [](const B& x, const B& y) { return x.middle() == y.middle() && x.radius() == y.radius(); };
    const CertainState<B> end = one.state_at(B(until)), other = many.state_at(B(until));
    EXPECT_TRUE(same(end.energy, other.energy));
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_TRUE(same(end.walls[side].given, other.walls[side].given));
      alone += end.walls[side].collisions;
    }
  }
  EXPECT_GE(alone, 500U);
}

// By the line that it had before, particle 0 would have met the wall at t = 2, and this is later, at t = 4.
TEST(CertifyWalls, ACollisionWithAWallBeforeTheLastOneOfItsParticleIsRefuted) {
  const auto list =
      std::make_shared<List<B>>(std::vector<B>{B(1), B(3)}, std::vector<B>{B(-1), B(double_double(-1.5), 0)});
  Checker<B> checker(std::make_shared<Walled<B>>(list, Wall<B>{B(0)}, std::nullopt), CertainLaw<B>());
  ASSERT_FALSE(checker.collision(0, 1));
  const auto doubt = checker.collision(-1, 0);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->check, Check::later);
  EXPECT_TRUE(doubt->refuted);
}

TEST(CertifyWalls, EveryStateInTheBallsOfTheStartStaysInThem) {
  std::uint64_t counted = 0;
  for (std::uint64_t number = 0; number < 200; ++number) {
    SCOPED_TRACE(number);
    const Drawn d = draw_with_walls(number);
    Gas<Rational> gas = off_the_middle(gas_of(d), number);
    Collisions collisions;
    while (collisions.size() < most_collisions)
      if (const auto next = gas.next(until))
        collisions.push_back(*next);
      else
        break;
    gas.time = until;
    Checker<B> checker(wide_particles(d), law_of(d));
    if (collisions.size() == most_collisions || !proved(checker, collisions)) continue;
    ++counted;
    const CertainState<B> end = checker.state_at(B(until));
    EXPECT_TRUE(holds(end.energy, gas.energy()));
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      EXPECT_TRUE(holds(x, gas.place(gas.cell_of(particle)))) << particle;
      EXPECT_TRUE(holds(v, gas.cell_of(particle).v)) << particle;
    });
    for (std::size_t side = 0; side < 2; ++side)
      if (d.walls[side]) expect_account(end.walls[side], *gas.walls[side]);
  }
  EXPECT_GE(counted, 100U);
}

TEST(CertifyWalls, WhereNothingApproachesAnyMoreTheyAreOver) {
  const auto over = [](const std::vector<int>& v, const std::vector<int>& walls) {
    std::vector<B> x, speeds;
    for (const int speed : v) x.emplace_back(static_cast<int>(x.size()) + 1), speeds.emplace_back(speed);
    std::optional<Wall<B>> left, right;
    if (!walls.empty()) left = Wall<B>{B(0), B(walls.front())};
    if (walls.size() > 1) right = Wall<B>{B(100), B(walls.back())};
    Checker<B> checker(std::make_shared<Walled<B>>(std::make_shared<List<B>>(x, speeds), left, right), CertainLaw<B>());
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
    Checker<B> checker(std::make_shared<Walled<B>>(
                           std::make_shared<List<B>>(std::vector<B>{B(1)}, std::vector<B>{B(-1)}, std::vector<B>{mass}),
                           wall, std::nullopt),
                       CertainLaw<B>());
    return checker.collision(-1, 0);
  };
  EXPECT_FALSE(doubt(B(1)));
  EXPECT_FALSE(doubt(from_text<B>("0.1")));
  const auto open = doubt(B(double_double(1) + double_double(0x1p-53), 1e-30));
  ASSERT_TRUE(open);
  EXPECT_EQ(open->check, Check::side);
  EXPECT_FALSE(open->refuted);
}

// ---- restitutions of the closing speed

TEST(CertifyRestitutionOfSpeed, WhatIsProvedIsWhatAHundredDigitsGive) {
  std::uint64_t counted = 0, collisions_proved = 0;
  for (std::uint64_t number = 0; number < 300; ++number) {
    SCOPED_TRACE(number);
    Drawn d = number % 3 == 0 ? draw_with_walls(number) : draw(number, false);
    for (auto& wall : d.walls)
      if (wall) wall->temperature = 0;
    d.length = 0;
    if (d.cutoff == 0) d.cutoff = 32;
    const char* const exponents[] = {"1", "4", "0.5", "2.5", "1.0"};
    const char* exponent = exponents[number % 5];
    const SpeedDependent<double> law(std::stod(d.restitution), d.cutoff / 64., std::stod(exponent));
    const Collisions collisions =
        made_by(Simulation(law, GapChain<double, IndividualMasses<double>>(particles_of<double>(d), 0.)));
    if (collisions.size() > most_collisions) continue;
    CertainLaw<B> certain = law_of(d);
    certain.cutoff_exponent = from_text<B>(exponent);
    Checker<B> checker(particles_of<B>(d), certain);
    if (!proved(checker, collisions)) continue;
    ++counted, collisions_proved += collisions.size();
    Gas<bin_float> gas = converted<bin_float>(gas_of(d));
    gas.cutoff_exponent = decimal<bin_float>(exponent);
    gas.advance(bin_float(until), 1000);
    ASSERT_FALSE(gas.tied);
    ASSERT_EQ(gas.collisions, collisions.size());
    ASSERT_EQ(gas.below_cutoff, checker.proved().below_cutoff);
    const CertainState<B> end = checker.state_at(B(until));
    EXPECT_TRUE(holds_wide(end.energy, gas.energy()));
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      const auto& cell = gas.cell_of(particle);
      EXPECT_TRUE(holds_wide(x, gas.place(cell))) << particle;
      EXPECT_TRUE(holds_wide(v, cell.v)) << particle;
      EXPECT_LT(v.radius(), 1e-20) << "not by being wide";
    });
  }
  EXPECT_GE(counted, 200U);
  EXPECT_GE(collisions_proved, 1500U);
}

TEST(CertifyRestitutionOfSpeed, EveryStateInTheBallsOfTheStartStaysInThem) {
  std::uint64_t counted = 0;
  for (std::uint64_t number = 0; number < 150; ++number) {
    SCOPED_TRACE(number);
    Drawn d = draw(number, false);
    d.length = 0;
    if (d.cutoff == 0) d.cutoff = 32;
    const char* const exponent = number % 2 == 0 ? "4" : "1.5";
    CertainLaw<B> certain = law_of(d);
    certain.cutoff_exponent = from_text<B>(exponent);
    Gas<bin_float> gas = off_the_middle(converted<bin_float>(gas_of(d)), number);
    gas.cutoff_exponent = decimal<bin_float>(exponent);
    Collisions collisions;
    while (collisions.size() < most_collisions)
      if (const auto next = gas.next(bin_float(until)))
        collisions.push_back(*next);
      else
        break;
    gas.time = bin_float(until);
    Checker<B> checker(wide_particles(d), certain);
    if (collisions.size() == most_collisions || !proved(checker, collisions)) continue;
    ++counted;
    EXPECT_TRUE(holds_wide(checker.state_at(B(until)).energy, gas.energy()));
    checker.for_each(B(until), [&](ParticleIndex particle, const B&, const B& x, const B& v) {
      EXPECT_TRUE(holds_wide(x, gas.place(gas.cell_of(particle)))) << particle;
      EXPECT_TRUE(holds_wide(v, gas.cell_of(particle).v)) << particle;
    });
  }
  EXPECT_GE(counted, 75U);
}

// A shock of identical particles: the errors of velocities are averaged, sigma = 4 and eps = 0.5 (certain_law.hpp).
// They stay within the roundings of a collision, 2^-95 or so, times the collisions of a particle.
TEST(CertifyRestitutionOfSpeed, ErrorsOfVelocitiesAreAveraged) {
  std::vector<double> x, v;
  for (int k = 0; k < 60; ++k) {
    x.push_back(k + static_cast<double>(random_bits(31, 0, static_cast<std::uint64_t>(k)) >> 40) * 0x1p-26);
    v.push_back(k < 30 ? 1 : -1);
  }
  const auto list = [&]<class T>(T) {
    return std::make_shared<List<T>>(std::vector<T>(x.begin(), x.end()), std::vector<T>(v.begin(), v.end()));
  };
  const SpeedDependent<double> law(0.5, 0.25, 4.);
  Collisions collisions;
  Simulation run(law, GapChain<double, IndividualMasses<double>>(list(0.), 0.));
  run.advance(60., [&](const Collision<double>& c) { collisions.emplace_back(c.left, c.right); });
  CertainLaw<B> certain;
  certain.restitution = B(0.5), certain.cutoff = B(0.25), certain.cutoff_exponent = B(4);
  std::vector<B> places, speeds;
  for (std::size_t k = 0; k < x.size(); ++k) places.emplace_back(x[k]), speeds.emplace_back(v[k]);
  Checker<B> checker(std::make_shared<List<B>>(places, speeds), certain);
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
        const Rational off = exact_middle(ball) - of_decimals(value), size = off < 0 ? Rational(-off) : off;
        return !(ball.radius() < 1e300) || size <= exactly(static_cast<double>(ball.radius())) + exactly(0x1p-148);
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

// x - c(x - y) (x - y) with c(w) = w/8 and a derivative w/4 of c(w) w, at the ends of x and y.
TEST(CertifyRestitutionOfSpeed, SharesThatDependOnADifferenceEnclose) {
  std::uint64_t counted = 0;
  for (std::uint64_t number = 0; number < 500; ++number) {
    const auto uniform = [&](std::uint64_t k) {
      return static_cast<double>(random_bits(8, number, k) >> 11) * 0x1p-53;
    };
    const B x(double_double(4 * uniform(0)), uniform(1) * 0.1), y(double_double(-4 * uniform(2)), uniform(3) * 0.1);
    const B apart = x - y, eighth = B(1) / B(8);
    const B::Share share(B(apart.middle(), 0) * eighth, apart * B(2) * eighth);
    const auto both = B::combined(x, y, apart, share, share);
    for (const int at_x : {-1, 0, 1})
      for (const int at_y : {-1, 0, 1}) {
        const Rational a = exact(x) + exactly(x.radius()) * at_x, b = exact(y) + exactly(y.radius()) * at_y, w = a - b;
        EXPECT_TRUE(holds(both.left, a - w * w / 8)) << number;
        EXPECT_TRUE(holds(both.right, b + w * w / 8)) << number;
        ++counted;
      }
  }
  EXPECT_EQ(counted, 4500U);
}

}  // namespace certify_walls_test
