// The paper's formulas for the front of the wet shock.
// Proves: the numbers of the validation table to all printed digits (closed forms evaluated elsewhere to 40 digits);
// that (8) in closed form solves its differential equation; that doubles lose no more than a stated number of roundings
// down to the smallest losses and up to the threshold.
#include "cradle/core/theory/wet_shock.hpp"

#include "cradle/core/theory/wet_energy.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tests/core/wet_reference.hpp"

namespace cradle::test::wet_theory_test {

using namespace cradle::theory;

// ---- the criterion ----

TEST(WetCriterion, IsRightWherePrintedOneIsNot) {
  // mu = 1/2: 2 sqrt(E/m); the printed form is sqrt 2 times that
  EXPECT_EQ(critical_closing_speed(0.25, 1.0, 1.0), 1.0);
  EXPECT_EQ(critical_closing_speed_printed(0.5, 1.0, 1.0), 2.0);
  EXPECT_EQ(critical_closing_speed(0.5, 2.0, 2.0), critical_closing_speed_printed(0.5, 2.0, 2.0)) << "mu = 1";
  for (const double heavy : {1.0, 7.0, 1e9}) {
    const double w = critical_closing_speed(0.05, heavy, 1.0);
    EXPECT_NEAR(heavy / (heavy + 1) * w * w / 2, 0.05, 4 * ulp * 0.05) << heavy;
  }
}

// ---- the front ----

TEST(WetFront, ReproducesTheReferenceDigits) {
  for (const WetTurnover& row : turnovers) {
    const auto shock = paper_shock(decimal(row.loss));
    const auto turn = *WetFront<Wide>(shock).turnover();
    EXPECT_DIGITS(turn.collisions, row.collisions);
    EXPECT_DIGITS(turn.time, row.time);
    EXPECT_DIGITS(Wide(turn.position - shock.origin()), row.reach);
    const auto last = *turnover_collision(shock);
    EXPECT_EQ(last.collision, row.n);
    EXPECT_DIGITS(last.time, row.discrete_time);
    EXPECT_DIGITS(Wide(last.position - shock.origin()), row.discrete_reach);
  }
}

TEST(WetFront, RecursionIsThePrintedOne) {
  for (const WetTurnover& row : turnovers) {
    const auto shock = paper_shock(decimal(row.loss));
    WetFrontRecursion<Wide> recursion(shock);
    Wide u = shock.speed, x = shock.origin(), t(0);
    for (std::uint64_t n = 0; n < row.n; ++n) {
      const Wide interval = shock.spacing / (u + shock.speed);
      x += u * interval;
      t += interval;
      u = (u - shock.speed) / 2 + sqrt(Wide(pow(Wide((u + shock.speed) / 2), 2) - shock.specific_loss()));
      const Wide before = recursion.now().velocity + shock.speed;
      ASSERT_TRUE(recursion.advance());
      EXPECT_WITHIN(recursion.now().velocity, u, tiny) << n;
      EXPECT_WITHIN(recursion.now().time, t, tiny * t) << n;
      EXPECT_WITHIN(recursion.now().position, x, tiny * t) << n;
      const Wide after = recursion.now().velocity + shock.speed;
      expect_close(before, after + shock.specific_loss() / after, tiny, "r_n = r_{n+1} + e/r_{n+1}");
    }
  }
}

TEST(WetFront, RecursionStandsBetweenItsCollisions) {
  const auto shock = paper_shock(decimal("0.01"));
  WetFrontRecursion<Wide> here(shock);
  for (int n = 0; n < 20; ++n) here.advance();
  auto next = here;
  next.advance();
  EXPECT_WITHIN(here.next_time(), next.now().time, 1000 * tiny);
  const Wide middle = (here.now().time + next.now().time) / 2;
  EXPECT_EQ(front_recursion_at(shock, middle).now().collision, 20U);
  EXPECT_EQ(front_recursion_at(shock, here.now().time).now().collision, 20U);
  EXPECT_WITHIN(*front_recursion_at(shock, middle).position_at(middle), (here.now().position + next.now().position) / 2,
                1000 * tiny);
}

TEST(WetFront, SticksAtTheThreshold) {
  // E = m u0^2: closing at 2 u0 = 2 sqrt e, which merges; nothing moves on
  WetFrontRecursion<double> stuck(paper_shock(0.25));
  EXPECT_TRUE(stuck.sticks_next());
  EXPECT_FALSE(stuck.advance());
  EXPECT_EQ(stuck.position_at(1.0), 0.0);
  EXPECT_FALSE(stuck.position_at(1.5));
  EXPECT_FALSE(turnover_collision(paper_shock(0.25)));
  const WetFront<double> front(paper_shock(0.25));
  EXPECT_FALSE(front.turnover());
  EXPECT_FALSE(front.sticking());
  EXPECT_FALSE(front.at_time(0.5));
  // between m u0^2/4 and m u0^2 it sticks before it has turned; there y = 1, r = 2 sqrt e
  for (const char* loss : {"0.0626", "0.1", "0.2", "0.2499"}) {
    const auto shock = paper_shock(decimal(loss));
    const WetFront<Wide> wide(shock);
    EXPECT_FALSE(wide.turnover()) << loss;
    expect_close(wide.sticking()->velocity + shock.speed, shock.critical_speed(), tiny, loss);
    EXPECT_FALSE(wide.at_time(Wide(wide.sticking()->time * (1 + tiny)))) << loss;
  }
  // at exactly a quarter it is caught as it comes to rest
  const WetFront<Wide> quarter(paper_shock(decimal("0.0625")));
  expect_close(quarter.turnover()->time, quarter.sticking()->time, tiny, "E = m u0^2/4");
}

TEST(WetFront, WithoutLossItFliesFreely) {
  const auto shock = paper_shock(0.0);
  EXPECT_FALSE(turnover_collision(shock));
  const WetFront<double> front(shock);
  EXPECT_FALSE(front.turnover());
  EXPECT_FALSE(front.sticking());
  for (const double t : {0.0, 0.25, 3.0, 1000.0}) {
    EXPECT_EQ(front.at_time(t)->position, 0.5 * t - 0.5);
    EXPECT_EQ(front.at_time(t)->velocity, 0.5);
    EXPECT_EQ(front.at_time(t)->collisions, t);
    EXPECT_EQ(front_recursion_at(shock, t).position_at(t), 0.5 * t - 0.5);
  }
}

TEST(WetFront, ClosedFormIsThatOfTheTable) {
  for (const WetTurnover& row : turnovers) {
    const auto shock = paper_shock(decimal(row.loss));
    const WetFront<Wide> front(shock);
    const Wide root = sqrt(shock.specific_loss());
    const auto y_of = [&](const Wide& u) {
      const Wide ratio = (u + shock.speed) / (2 * root);
      return Wide(ratio + sqrt(Wide(ratio * ratio - 1)));
    };
    const Wide y0 = y_of(shock.speed);
    for (const char* velocity : {"0.49", "0.3", "0", "-0.04"}) {
      const Wide u = decimal(velocity);
      const Wide y = y_of(u);
      const auto here = *front.at_velocity(u);
      // the printed differences lose up to y0^2 = 1e4 in n
      EXPECT_WITHIN(here.collisions, (y0 * y0 - y * y) / 2 - log(Wide(y0 / y)), tiny * 10000);
      EXPECT_WITHIN(here.time, shock.spacing / root * ((y0 - y) - 2 * (atan(y0) - atan(y))), tiny * 10000);
      EXPECT_WITHIN(here.position, shock.origin() + here.collisions * shock.spacing - shock.speed * here.time,
                    tiny * 10000);
      const auto again = *front.at_time(here.time);
      EXPECT_WITHIN(again.velocity, u, tiny * 10000) << "t -> u is the inverse of u -> t";
      EXPECT_WITHIN(again.position, here.position, tiny * 10000);
    }
  }
}

TEST(WetFront, ClosedFormSolvesTheDifferentialEquation) {
  const auto shock = paper_shock(decimal("0.01"));
  const WetFront<Wide> front(shock);
  const Wide step = pow(Wide(10), -14);
  for (const char* velocity : {"0.45", "0.1", "-0.2"}) {
    const Wide u = decimal(velocity);
    const auto lower = *front.at_velocity(Wide(u - step)), upper = *front.at_velocity(Wide(u + step));
    const Wide half = (u + shock.speed) / 2;
    const Wide slope = -half + sqrt(Wide(half * half - shock.specific_loss()));  // du/dn
    const Wide central = 2 * step / (upper.collisions - lower.collisions);
    expect_close(central, slope, pow(Wide(10), -24), "du/dn, to the square of the step");
    const Wide interval = (upper.time - lower.time) / (upper.collisions - lower.collisions);
    expect_close(interval, shock.spacing / (u + shock.speed), pow(Wide(10), -24), "dt/dn = l/(u + u0)");
    const Wide moved = (upper.position - lower.position) / (upper.time - lower.time);
    EXPECT_WITHIN(moved, u, pow(Wide(10), -24)) << "dx/dt = u";
  }
}

// Doubles against Wide at the same binary parameters.
TEST(WetFront, DoublesLoseNothingAtSmallLosses) {
  for (int bits = 3; bits <= 900; bits += bits < 60 ? 1 : 97) {
    const double loss = std::ldexp(1.0, -bits - 2);
    const auto shock = paper_shock(loss);
    const WetFront<double> front(shock);
    const WetFront<Wide> wide(paper_shock(Wide(loss)));
    const std::string what = "E = 2^-" + std::to_string(bits + 2);
    // Each form is a sum of positive terms of some 30 roundings; near the turnover u is a difference of two halves.
    const Wide few = 60 * ulp;
    expect_close(front.turnover()->collisions, wide.turnover()->collisions, few, what);
    expect_close(front.turnover()->time, wide.turnover()->time, few, what);
    for (const double part : {1e-9, 0.01, 0.25, 0.75}) {
      const double t = part * front.turnover()->time;
      const auto here = *front.at_time(t);
      const auto exact = *wide.at_time(Wide(t));
      expect_close(here.collisions, exact.collisions, few, what);
      expect_close(here.velocity, exact.velocity, 4 * few, what);
      if (part > 0.1) expect_close(here.position - shock.origin(), exact.position + Wide(0.5), 4 * few, what);
    }
  }
}

TEST(WetFront, DoublesLoseNothingNearTheThreshold) {
  // u0 = 1, sqrt e = 1 - 2^-b, whose square is exact: the rows stick after a short while, and h0 = u0/sqrt e - 1 is
  // exact
  for (int bits = 2; bits <= 26; ++bits) {
    const double root = 1 - std::ldexp(1.0, -bits);
    const auto end = WetFront<double>(WetShock<double>{root * root, 1}).sticking();
    const auto expected = WetFront<Wide>(WetShock<Wide>{Wide(root * root), Wide(1)}).sticking();
    const Wide few = 60 * ulp;
    expect_close(end->collisions, expected->collisions, few, std::to_string(bits));
    expect_close(end->time, expected->time, few, std::to_string(bits));
  }
}

TEST(WetFront, CompensatedSumsKeepTheRecursionInDouble) {
  for (const double loss : {1e-4, 1e-5}) {
    const auto shock = paper_shock(loss);
    const auto last = *turnover_collision(shock);
    const auto exact = *turnover_collision(paper_shock(Wide(loss)));
    ASSERT_EQ(last.collision, exact.collision);
    // Each loss rounds e/w twice; errors of u grow by y0/y = 2 up to the turnover, whatever n is.
    expect_close(last.time, exact.time, 20 * ulp, "t_n");
    EXPECT_WITHIN(last.velocity, exact.velocity, 20 * ulp);
    expect_close(last.position, exact.position, 40 * ulp, "x_n");
  }
  EXPECT_THROW(turnover_collision(paper_shock(1e-5), 1000), std::overflow_error);
}

TEST(WetFront, HasTheScalesOfItsUnits) {
  // lengths x 4, times x 8, masses x 2: powers of two, so the bits are the same
  const WetShock<double> unit{0.01}, scaled{0.01 * 2 * 16 / 64, 0.5 * 4 / 8, 4, 2};
  const auto a = *WetFront<double>(unit).turnover(), b = *WetFront<double>(scaled).turnover();
  EXPECT_EQ(b.collisions, a.collisions);
  EXPECT_EQ(b.time, 8 * a.time);
  EXPECT_EQ(b.position, 4 * a.position);
  EXPECT_EQ(turnover_collision(scaled)->time, 8 * turnover_collision(unit)->time);
  EXPECT_EQ(wet_collisions(scaled, 8 * 30.0), wet_collisions(unit, 30.0));
  const WetZone<double> zone(unit), larger(scaled);
  EXPECT_EQ(larger.half_width(), 4 * zone.half_width());
  EXPECT_EQ(larger.force(4 * 0.7), zone.force(0.7) * 2 * 4 / 64);
}

}  // namespace cradle::test::wet_theory_test
