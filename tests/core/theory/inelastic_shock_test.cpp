// The paper's formulas for the inelastic shock, and those for its collapse and that of few particles.
// Proves: closed forms to all digits of the reference values (evaluated to 40 digits elsewhere, printed to 18), the
// limits eps -> 1 and t -> 0 and those of restitution, from both sides, what the linear profiles conserve, and that
// doubles lose no more than a stated number of roundings.
#include "cradle/core/theory/inelastic_shock.hpp"

#include <array>

#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::inelastic_shock_test {

using namespace cradle::theory;

template <class T> InelasticShock<T> paper_shock(const T& eps) { return {.restitution = eps, .particles = 8000}; }

// Identities evaluated in Wide: a few hundred roundings of 2^-168, some after factors of up to 1e4.
const Wide tiny = pow(Wide(10), -44);

// ---- the front ----

TEST(InelasticFront, ReproducesTheReferenceDigits) {
  struct Row {
    int denominator;
    const char *turnover, *reach, *discrete_reach;
    std::uint64_t collision;
    const char* time;
  };
  const std::array rows{Row{1000, "1999", "386.447758641255552", "386.447771021476687", 1386, "1999.10445795704663"},
                        Row{100, "199", "38.7825729860609660", "38.7830812554337329", 139, "200.433837489132534"}};
  for (const Row& row : rows) {
    const auto shock = paper_shock<Wide>(Wide(row.denominator - 1) / row.denominator);
    EXPECT_WITHIN(*turnover_time(shock), decimal(row.turnover), decimal(row.turnover) * tiny);
    EXPECT_DIGITS(*maximal_front(shock), row.reach);
    const auto turn = *turnover_collision(shock);
    EXPECT_EQ(turn.collision, row.collision);
    EXPECT_DIGITS(turn.time, row.time);
    EXPECT_DIGITS(Wide(turn.position - shock.origin()), row.discrete_reach);
  }
}

TEST(InelasticFront, ClosedFormSolvesTheRecursion) {
  for (const char* eps : {"1", "0.999", "0.9", "0.5", "0"}) {
    auto shock = paper_shock<Wide>(decimal(eps));
    shock.spacing = decimal("0.7");
    shock.speed = decimal("1.3");
    FrontRecursion<Wide> recursion(shock);
    for (std::uint64_t n = 0; n <= 60; ++n, recursion.advance()) {
      const auto closed = front_collision(shock, n);
      EXPECT_EQ(recursion.now().collision, n);
      // an error made in a recursive u is amplified by what the later intervals grow, (2/(1+eps))^n <= 2^60
      const Wide tolerance = tiny * pow(Wide(2 / (1 + shock.restitution)), static_cast<int>(n));
      EXPECT_WITHIN(closed.velocity, recursion.now().velocity, tolerance) << eps << " " << n;
      EXPECT_WITHIN(closed.time, recursion.now().time, tolerance * (1 + closed.time)) << eps << " " << n;
      EXPECT_WITHIN(closed.position, recursion.now().position, tolerance * (1 + closed.time)) << eps << " " << n;
    }
  }
}

TEST(InelasticFront, FirstCollisionIsAtTheCentre) {
  for (const double eps : {0.0, 0.3, 0.999, 1.0}) {
    const auto first = front_collision(paper_shock(eps), 1);
    EXPECT_EQ(first.time, 1.0);
    EXPECT_EQ(first.position, 0.0);
    // (1-kappa)/(1+kappa) = eps: one division and three additions
    EXPECT_NEAR(first.velocity, 0.5 * eps, 4 * std::numeric_limits<double>::epsilon());
  }
}

TEST(InelasticFront, DiscretePositionPassesThroughEveryCollision) {
  const auto shock = paper_shock<Wide>(decimal("0.99"));
  for (const std::uint64_t n : {1U, 2U, 17U, 139U, 200U}) {
    const auto here = front_collision(shock, n);
    const auto next = front_collision(shock, n + 1);
    const Wide middle = (here.time + next.time) / 2;
    EXPECT_EQ(front_collision_before(shock, here.time).collision, n);
    EXPECT_EQ(front_collision_before(shock, middle).collision, n);
    EXPECT_WITHIN(front_position_discrete(shock, middle), (here.position + next.position) / 2, 1000 * tiny);
  }
  EXPECT_EQ(front_collision_before(shock, Wide(0)).collision, 0U);
  // the continuous form interpolates the collisions: (5) with t = t_n is x_n exactly
  for (const std::uint64_t n : {0U, 1U, 50U, 139U}) {
    const auto here = front_collision(shock, n);
    EXPECT_WITHIN(front_position(shock, here.time), here.position, 1000 * tiny);
  }
}

TEST(InelasticFront, TurnsWhereTheContinuousVelocityVanishes) {
  for (const char* eps : {"0.1", "0.9", "0.999", "0.999999"}) {
    const auto shock = paper_shock<Wide>(decimal(eps));
    const Wide turn = *turnover_time(shock);
    EXPECT_LE(abs(front_velocity(shock, turn)), tiny);
    expect_close(front_displacement(shock, turn), *maximal_front(shock), tiny, "x_f(t*)");
    // (4) is d(5)/dt up to O(1-eps): the logarithm's kappa/ln(1+kappa) - 1 = kappa/2 of the 2 u0/(1+s) term, at most u0
    // kappa
    const Wide step = turn * pow(Wide(10), -12);
    const Wide t = turn / 2;
    const Wide slope =
        (front_displacement(shock, Wide(t + step)) - front_displacement(shock, Wide(t - step))) / (2 * step);
    EXPECT_WITHIN(slope, front_velocity(shock, t), shock.speed * shock.kappa());
    EXPECT_GE(abs(Wide(slope - front_velocity(shock, t))), Wide(shock.speed * shock.kappa() / 2));
  }
}

TEST(InelasticFront, ElasticRowsPassFreely) {
  const auto shock = paper_shock<double>(1.0);
  EXPECT_FALSE(turnover_time(shock));
  EXPECT_FALSE(maximal_front(shock));
  EXPECT_FALSE(turnover_collision(shock));
  EXPECT_FALSE(collapse_onset_time(shock));
  for (const double t : {0.0, 0.25, 3.0, 1000.0}) {
    EXPECT_EQ(front_velocity(shock, t), 0.5);
    EXPECT_EQ(front_displacement(shock, t), 0.5 * t);
    EXPECT_EQ(front_position_discrete(shock, t), 0.5 * t - 0.5);
    EXPECT_EQ(energy(shock, t), initial_energy(shock));
  }
  const auto collision = front_collision(shock, 1000);
  EXPECT_EQ(collision.time, 1000.0);
  EXPECT_EQ(collision.position, 499.5);
  EXPECT_EQ(collision.velocity, 0.5);
  EXPECT_EQ(interaction_density(shock, 10.0), 2.0);
  EXPECT_EQ(mean_velocity_slope(shock, 10.0), 0.0);
  EXPECT_EQ(mean_velocity_slope_early(shock), 0.0);
}

// Doubles against Wide at the same (binary) parameters, all the way to eps one ulp below 1.
TEST(InelasticFront, DoublesLoseNothingAsRestitutionTendsToOne) {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (int bits = 1; bits <= 53; ++bits) {
    const double eps = 1 - std::ldexp(1.0, -bits);
    const auto shock = paper_shock(eps);
    const auto wide = paper_shock(Wide(eps));
    const std::string what = "1 - eps = 2^-" + std::to_string(bits);
    // Each is below 30 roundings; positions of the front are a difference of at most four times its value.
    const Wide few = 30 * ulp;
    expect_close(*turnover_time(shock), *turnover_time(wide), few, what);
    expect_close(*maximal_front(shock), *maximal_front(wide), few, what);
    expect_close(*collapse_onset_time(shock), *collapse_onset_time(wide), few, what);
    expect_close(mean_velocity_slope_early(shock), mean_velocity_slope_early(wide), few, what);
    for (const double part : {1e-6, 0.01, 0.25, 0.75}) {
      const double t = part * *turnover_time(shock);
      const Wide wide_t(t);
      expect_close(front_displacement(shock, t), front_displacement(wide, wide_t), few, what);
      expect_close(front_velocity(shock, t), front_velocity(wide, wide_t), few, what);
      if (t > 1000) {  // the slope is a difference of lag and slowing, of which half is left
        expect_close(mean_velocity_slope(shock, t), mean_velocity_slope(wide, wide_t), 4 * few, what);
        expect_close(interaction_density(shock, t), interaction_density(wide, wide_t), few, what);
      }
    }
    for (const std::uint64_t n : {3U, 100U, 12345U}) {
      if (static_cast<double>(n) * std::ldexp(1.0, -bits) > 0.5) continue;  // before the turnover
      const auto collision = front_collision(shock, n);
      const auto exact = front_collision(wide, n);
      expect_close(collision.time, exact.time, few, what);
      expect_close(collision.velocity, exact.velocity, 2 * few, what);
      expect_close(collision.position - shock.origin(), exact.position - wide.origin(), 4 * few, what);
    }
  }
}

template <class T> void expect_own_precision() {
  const InelasticShock<T> shock = paper_shock(T(T(999) / T(1000)));
  const auto wide = paper_shock(Wide(shock.restitution));
  const Wide few = 30 * Wide(std::numeric_limits<T>::epsilon());
  expect_close(*maximal_front(shock), *maximal_front(wide), few, "x_max");
  expect_close(front_displacement(shock, T(700)), front_displacement(wide, Wide(700)), few, "(5)");
  expect_close(energy(shock, T(700)), energy(wide, Wide(700)), few, "(7)");
  expect_close(*collapse_onset_time(shock), *collapse_onset_time(wide), few, "onset");
  expect_close(collapse_limit<T>(3), collapse_limit<Wide>(3), few, "7 - 4 sqrt 3");
}
TEST(InelasticFront, AgreesWithWideToThePrecisionOfAnyBuiltInType) {
  expect_own_precision<float>();
  expect_own_precision<double>();
  expect_own_precision<long double>();
}

// ---- profiles, slope, energy ----

TEST(InelasticProfiles, HoldTheParticlesThatHaveEntered) {
  const auto shock = paper_shock<Wide>(decimal("0.999"));
  for (const char* time : {"100", "499.75", "1500"}) {
    const Wide t = decimal(time);
    const Wide front = front_displacement(shock, t);
    // linear in x: the trapezoid is exact
    const Wide right = front * (right_mover_density(shock, front, t) + right_mover_density(shock, Wide(-front), t));
    const Wide left = front * (left_mover_density(shock, front, t) + left_mover_density(shock, Wide(-front), t));
    expect_close(right, front + shock.speed * t, tiny, "number of right-movers");
    expect_close(left, right, tiny, "number of left-movers");
    for (const char* place : {"-1", "-0.3", "0.8"}) {
      const Wide x = decimal(place) * front;
      const Wide plus = right_mover_density(shock, x, t);
      const Wide minus = left_mover_density(shock, x, t);
      expect_close(plus + minus, interaction_density(shock, t), tiny, "rho_int");
      const Wide current = plus * right_mover_velocity(shock, x, t) + minus * left_mover_velocity(shock, x, t);
      expect_close(current / (plus + minus), mean_velocity(shock, x, t), tiny, "equation (6)");
    }
    EXPECT_EQ(right_mover_density(shock, Wide(-front), t), 1);
    EXPECT_EQ(right_mover_velocity(shock, Wide(-front), t), shock.speed);
  }
}

TEST(InelasticProfiles, EnergyOfTheProfilesIsEquationSeven) {
  const auto shock = paper_shock<Wide>(decimal("0.99"));
  const Wide t(120);
  const Wide front = front_displacement(shock, t);
  // rho u^2 is cubic in x: two Gauss points are exact
  Wide inside(0);
  for (const int sign : {-1, 1}) {
    const Wide x = sign * front / sqrt(Wide(3));
    inside += front * right_mover_density(shock, x, t) * pow(right_mover_velocity(shock, x, t), 2) / 2;
    inside += front * left_mover_density(shock, x, t) * pow(left_mover_velocity(shock, x, t), 2) / 2;
  }
  const Wide entered = 2 * (front + shock.speed * t);
  expect_close(energy(shock, t), initial_energy(shock) - entered * pow(shock.speed, 2) / 2 + inside, tiny, "(7)");
}

TEST(InelasticProfiles, SlopeTendsToItsSecondLine) {
  // l << u0 t << l/(1-eps): with 1-eps = 1e-12 and tau = (1-eps) u0 t/l, deviations are tau and (1-eps)/(2 tau)
  const auto shock = paper_shock<Wide>(Wide(1 - decimal("1e-12")));
  const Wide early = mean_velocity_slope_early(shock);
  for (const char* digits : {"1e-3", "1e-4", "1e-5"}) {
    const Wide tau = decimal(digits);
    const Wide t = tau * decimal("1e12") / shock.speed;
    expect_close(mean_velocity_slope(shock, t), early, tau + decimal("1e-12") / tau, digits);
  }
  EXPECT_WITHIN(mean_velocity_slope_early(paper_shock<Wide>(decimal("0.999"))), -decimal("2.5006e-4"), decimal("5e-9"));
}

TEST(InelasticProfiles, EnergyIsOffTheSimulationAsStated) {
  // N-particle energies at eps = 0.999, N = 8000 (t = 999.5, 1999); the percentages are of the energy lost, to two
  // digits.
  const auto shock = paper_shock(0.999);
  EXPECT_EQ(initial_energy(shock), 1000.0);
  EXPECT_NEAR(1 - (1000 - energy(shock, 999.5)) / (1000 - 887.274363235560075), 0.054, 5e-4);
  EXPECT_NEAR(1 - (1000 - energy(shock, 1999.0)) / (1000 - 738.145120941488556), 0.15, 5e-3);
  for (int k = 1; k < 40; ++k) {
    const double t = 50.0 * k;
    EXPECT_LT(energy(shock, t), initial_energy(shock));
    EXPECT_GT(energy(shock, t), sticky_energy(shock, t));
  }
}

TEST(StickyEnergy, EndsWithTheRows) {
  auto shock = paper_shock(0.999);
  EXPECT_EQ(sticky_energy(shock, 0.0), 1000.0);
  EXPECT_EQ(sticky_energy(shock, 4000.0), 500.0);
  EXPECT_EQ(sticky_energy(shock, 8000.0), 0.0);
  EXPECT_EQ(sticky_energy(shock, 9000.0), 0.0);
  shock.mass = 3;
  EXPECT_EQ(sticky_energy(shock, 4000.0), 1500.0);
}

TEST(InelasticShock, HasTheScalesOfItsUnits) {
  // lengths x 4, times x 8, masses x 2: powers of two, so the bits are the same
  const InelasticShock<double> unit{.restitution = 0.99, .particles = 200}, scaled{0.99, 0.5 * 4 / 8, 4, 2, 200};
  EXPECT_EQ(front_position(scaled, 8 * 50.0), 4 * front_position(unit, 50.0));
  EXPECT_EQ(front_velocity(scaled, 8 * 50.0), front_velocity(unit, 50.0) / 2);
  EXPECT_EQ(interaction_density(scaled, 8 * 50.0), interaction_density(unit, 50.0) / 2);
  EXPECT_EQ(mean_velocity_slope(scaled, 8 * 50.0), mean_velocity_slope(unit, 50.0) / 8);
  EXPECT_EQ(mean_velocity_slope_early(scaled), mean_velocity_slope_early(unit) / 8);
  EXPECT_EQ(*maximal_front(scaled), 4 * *maximal_front(unit)) << "whatever the speed";
  EXPECT_EQ(energy(scaled, 8 * 50.0), energy(unit, 50.0) / 2);
  EXPECT_EQ(sticky_energy(scaled, 8 * 50.0), sticky_energy(unit, 50.0) / 2);
  EXPECT_EQ(*collapse_onset_time(scaled), 8 * *collapse_onset_time(unit));
}

// ---- the collapse of few particles, and the time at which a shock collapses ----

TEST(Collapse, OnsetReproducesTheReferenceDigits) {
  const std::array<std::array<const char*, 2>, 3> rows{{{"0.999", "6280.04"}, {"0.99", "625.17"}, {"0.9", "59.66"}}};
  for (const auto& [eps, time] : rows) EXPECT_DIGITS(*collapse_onset_time(InelasticShock<Wide>{decimal(eps)}), time);
  for (int n = 2; n <= 100; n += 7)
    expect_close(*collapse_onset_particles(collapse_limit<Wide>(n)), n, tiny, "inverse of the limit");
  EXPECT_EQ(*collapse_onset_particles(0.0), 2.0);
}

TEST(Collapse, LimitsReproduceTheReferenceDigits) {
  EXPECT_DIGITS(collapse_limit<Wide>(3), "0.0717967697244908258902146339765105");
  expect_close(collapse_limit<Wide>(3), 7 - 4 * sqrt(Wide(3)), tiny, "three particles");
  expect_close(collapse_limit<Wide>(4), 3 - 2 * sqrt(Wide(2)), tiny, "four particles");
  for (const int n : {3, 4, 5, 12, 100}) {
    const Wide limit = collapse_limit<Wide>(n);
    EXPECT_TRUE(collapse_rates(Wide(limit * (1 - tiny)), checkerboard_coupling(Wide(limit * (1 - tiny)), n)));
    EXPECT_FALSE(collapse_rates(Wide(limit * (1 + tiny)), checkerboard_coupling(Wide(limit * (1 + tiny)), n)));
  }
}

TEST(Collapse, ThreeParticlesReproduceTheReferenceDigits) {
  // x = (0, 1, 3), v = (1, 0, -1): gaps 1 and 2, both closing at 1
  const auto time = [](const Wide& eps, const Wide& speed_of_the_second_gap) {
    const Wide coupling = checkerboard_coupling(eps, 3);
    return collapse_time(eps, coupling, Wide(1), Wide(1), Wide(1), Wide(speed_of_the_second_gap + coupling));
  };
  for (const ThreeCollapse& row : three_collapses) {
    EXPECT_DIGITS(*time(decimal(row.eps), 1), row.collapse_time);
    EXPECT_FALSE(time(decimal(row.eps), -1)) << "the third runs away";
  }
  const auto rates = *collapse_rates(decimal("0.05"), checkerboard_coupling(decimal("0.05"), 3));
  expect_close(rates.plus, decimal("0.4"), tiny, "lam+");
  expect_close(rates.minus, decimal("0.125"), tiny, "lam-");
  EXPECT_FALSE(time(decimal("0.08"), 1));
}

TEST(Collapse, FourParticlesInTheCheckerboardPattern) {
  // Gaps (1,2,1) all closing at 1. Amplitudes: outer pairs sqrt 2 times the gap, the middle one as it is.
  const auto time = [](const Wide& eps) {
    const Wide coupling = checkerboard_coupling(eps, 4);
    const Wide p0 = sqrt(Wide(2));
    return collapse_time(eps, coupling, Wide(1), p0, Wide(1), Wide(1 + coupling * p0));
  };
  expect_close(*time(decimal("0.15")), Wide(11) / 7, tiny, "eps = .15");
  // Source: the surd 1 + 1/(2.1 - sqrt 2 lam-) and a plain event-driven run, both at 60 digits. (The validation table
  // has the 20th and 23rd decimals, 4 and 0, interchanged.)
  EXPECT_DIGITS(*time(decimal("0.1")), "1.53471469049059024594590831142126492903216478");
  EXPECT_FALSE(time(decimal("0.18")));
  // coupling: the closed forms for 3 and 4 particles are the cosine of the others
  const Wide pi = 4 * atan(Wide(1));
  expect_close(checkerboard_coupling(decimal("0.1"), 4), decimal("1.1") * cos(Wide(pi / 4)), tiny, "n = 4");
  expect_close(checkerboard_coupling(decimal("0.1"), 3), decimal("1.1") * cos(Wide(pi / 3)), tiny, "n = 3");
}

}  // namespace cradle::test::inelastic_shock_test
