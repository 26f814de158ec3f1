// The paper's formulas for the inelastic shock and for few-body collapse.
// Proves: closed forms to all digits of the reference values (evaluated to 40 digits elsewhere, printed to 18), the
// limits eps -> 1 and t -> 0, what the linear profiles conserve, that doubles lose no more than a stated number of
// roundings, and that nothing assumes a built-in scalar: a strict type without conversions to or from double goes
// through everything.
#include "cradle/core/theory/inelastic_collapse.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace theory_test {

using namespace cradle::theory;
using Wide = boost::multiprecision::cpp_bin_float_50;  // 168 bits, expression templates on

/// Arithmetic of Wide, an int to build one, ADL maths, and nothing else.
class Strict {
 public:
  explicit Strict(int value) : value_(value) {}
  explicit Strict(const Wide& value) : value_(value) {}
  const Wide& wide() const { return value_; }

  friend Strict operator+(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ + b.value_)); }
  friend Strict operator-(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ - b.value_)); }
  friend Strict operator*(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ * b.value_)); }
  friend Strict operator/(const Strict& a, const Strict& b) { return Strict(Wide(a.value_ / b.value_)); }
  friend Strict operator-(const Strict& a) { return Strict(Wide(-a.value_)); }
  friend bool operator<(const Strict& a, const Strict& b) { return a.value_ < b.value_; }
  friend bool operator>(const Strict& a, const Strict& b) { return b < a; }
  friend bool operator==(const Strict& a, const Strict& b) { return a.value_ == b.value_; }
  friend Strict sqrt(const Strict& a) { return Strict(Wide(sqrt(a.value_))); }
  friend Strict log(const Strict& a) { return Strict(Wide(log(a.value_))); }
  friend Strict atan(const Strict& a) { return Strict(Wide(atan(a.value_))); }
  friend Strict cos(const Strict& a) { return Strict(Wide(cos(a.value_))); }

 private:
  Wide value_;
};

template <class T> InelasticShock<T> paper_shock(const T& eps) {
  InelasticShock<T> shock{eps};
  shock.particles = 8000;
  return shock;
}

Wide decimal(const char* digits) { return Wide(std::string(digits)); }

/// Half a unit in the last place that the reference was printed to.
Wide printed_tolerance(const std::string& digits) {
  const auto point = digits.find('.');
  const auto places = point == std::string::npos ? 0 : static_cast<int>(digits.size() - point - 1);
  return pow(Wide(10), -places) * Wide(51) / Wide(100);
}

#define EXPECT_DIGITS(value, digits)                                                                                   \
  EXPECT_LE(abs(Wide((value)-decimal(digits))), printed_tolerance(digits)) << "value " << Wide(value).str(30)

void expect_close(const Wide& value, const Wide& expected, const Wide& relative, const std::string& what) {
  EXPECT_LE(abs(Wide(value - expected)), Wide(relative * abs(expected))) << what << ": " << value << " / " << expected;
}

// Identities evaluated in Wide: a few hundred roundings of 2^-168, some after factors of up to 1e4.
const Wide tiny = pow(Wide(10), -44);

// ---- the front ----

TEST(InelasticFront, ReproducesTheReferenceDigits) {
  struct Row {
    int denominator;
    const char *turnover, *reach, *discrete_reach;
    std::uint64_t contact;
    const char* time;
  };
  const std::array rows{Row{1000, "1999", "386.447758641255552", "386.447771021476687", 1386, "1999.10445795704663"},
                        Row{100, "199", "38.7825729860609660", "38.7830812554337329", 139, "200.433837489132534"}};
  for (const Row& row : rows) {
    const auto shock = paper_shock<Wide>(Wide(row.denominator - 1) / row.denominator);
    EXPECT_LE(abs(Wide(*turnover_time(shock) - decimal(row.turnover))), Wide(decimal(row.turnover) * tiny));
    EXPECT_DIGITS(*maximal_front(shock), row.reach);
    const auto turn = *turnover_contact(shock);
    EXPECT_EQ(turn.contact, row.contact);
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
      const auto closed = front_contact(shock, n);
      EXPECT_EQ(recursion.now().contact, n);
      // an error made in a recursive u is amplified by what the later intervals grow, (2/(1+eps))^n <= 2^60
      const Wide tolerance = tiny * pow(Wide(2 / (1 + shock.restitution)), static_cast<int>(n));
      EXPECT_LE(abs(Wide(closed.velocity - recursion.now().velocity)), tolerance) << eps << " " << n;
      EXPECT_LE(abs(Wide(closed.time - recursion.now().time)), Wide(tolerance * (1 + closed.time))) << eps << " " << n;
      EXPECT_LE(abs(Wide(closed.position - recursion.now().position)), Wide(tolerance * (1 + closed.time)))
          << eps << " " << n;
    }
  }
}

TEST(InelasticFront, FirstContactIsAtTheCentre) {
  for (const double eps : {0.0, 0.3, 0.999, 1.0}) {
    const auto first = front_contact(paper_shock(eps), 1);
    EXPECT_EQ(first.time, 1.0);
    EXPECT_EQ(first.position, 0.0);
    // (1-kappa)/(1+kappa) = eps: one division and three additions
    EXPECT_NEAR(first.velocity, 0.5 * eps, 4 * std::numeric_limits<double>::epsilon());
  }
}

TEST(InelasticFront, DiscretePositionPassesThroughEveryContact) {
  const auto shock = paper_shock<Wide>(decimal("0.99"));
  for (const std::uint64_t n : {1U, 2U, 17U, 139U, 200U}) {
    const auto here = front_contact(shock, n);
    const auto next = front_contact(shock, n + 1);
    const Wide middle = (here.time + next.time) / 2;
    EXPECT_EQ(front_contact_before(shock, here.time).contact, n);
    EXPECT_EQ(front_contact_before(shock, middle).contact, n);
    EXPECT_LE(abs(Wide(front_position_discrete(shock, middle) - (here.position + next.position) / 2)), 1000 * tiny);
  }
  EXPECT_EQ(front_contact_before(shock, Wide(0)).contact, 0U);
  // the continuous form interpolates the contacts: (5) with t = t_n is x_n exactly
  for (const std::uint64_t n : {0U, 1U, 50U, 139U}) {
    const auto here = front_contact(shock, n);
    EXPECT_LE(abs(Wide(front_position(shock, here.time) - here.position)), 1000 * tiny);
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
    EXPECT_LE(abs(Wide(slope - front_velocity(shock, t))), Wide(shock.speed * shock.kappa()));
    EXPECT_GE(abs(Wide(slope - front_velocity(shock, t))), Wide(shock.speed * shock.kappa() / 2));
  }
}

TEST(InelasticFront, ReachDoesNotDependOnTheSpeed) {
  auto shock = paper_shock<Wide>(decimal("0.99"));
  const Wide reach = *maximal_front(shock);
  shock.speed = Wide(7);
  EXPECT_EQ(*maximal_front(shock), reach);
  EXPECT_LE(abs(Wide(front_displacement(shock, *turnover_time(shock)) - reach)), 1000 * tiny);
}

TEST(InelasticFront, ElasticRowsPassFreely) {
  const auto shock = paper_shock<double>(1.0);
  EXPECT_FALSE(turnover_time(shock));
  EXPECT_FALSE(maximal_front(shock));
  EXPECT_FALSE(turnover_contact(shock));
  EXPECT_FALSE(collapse_onset_time(shock));
  for (const double t : {0.0, 0.25, 3.0, 1000.0}) {
    EXPECT_EQ(front_velocity(shock, t), 0.5);
    EXPECT_EQ(front_displacement(shock, t), 0.5 * t);
    EXPECT_EQ(front_position_discrete(shock, t), 0.5 * t - 0.5);
    EXPECT_EQ(energy(shock, t), initial_energy(shock));
  }
  const auto contact = front_contact(shock, 1000);
  EXPECT_EQ(contact.time, 1000.0);
  EXPECT_EQ(contact.position, 499.5);
  EXPECT_EQ(contact.velocity, 0.5);
  EXPECT_EQ(interaction_density(shock, 10.0), 2.0);
  EXPECT_EQ(mean_velocity_slope(shock, 10.0), 0.0);
  EXPECT_EQ(mean_velocity_slope_early(shock), 0.0);
  EXPECT_EQ(detail::from_count<double>(9007199254740993U), 9007199254740992.0);
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
      const auto contact = front_contact(shock, n);
      const auto exact = front_contact(wide, n);
      expect_close(contact.time, exact.time, few, what);
      expect_close(contact.velocity, exact.velocity, 2 * few, what);
      expect_close(contact.position - shock.origin(), Wide(exact.position - wide.origin()), 4 * few, what);
    }
  }
}

// ---- profiles, slope, energy ----

TEST(InelasticProfiles, HoldTheBodiesThatHaveEntered) {
  const auto shock = paper_shock<Wide>(decimal("0.999"));
  for (const char* time : {"100", "499.75", "1500"}) {
    const Wide t = decimal(time);
    const Wide front = front_displacement(shock, t);
    // linear in x: the trapezoid is exact
    const Wide right = front * (right_mover_density(shock, front, t) + right_mover_density(shock, Wide(-front), t));
    const Wide left = front * (left_mover_density(shock, front, t) + left_mover_density(shock, Wide(-front), t));
    expect_close(right, Wide(front + shock.speed * t), tiny, "number of right-movers");
    expect_close(left, right, tiny, "number of left-movers");
    for (const char* place : {"-1", "-0.3", "0.8"}) {
      const Wide x = decimal(place) * front;
      const Wide plus = right_mover_density(shock, x, t);
      const Wide minus = left_mover_density(shock, x, t);
      expect_close(Wide(plus + minus), interaction_density(shock, t), tiny, "rho_int");
      const Wide current = plus * right_mover_velocity(shock, x, t) + minus * left_mover_velocity(shock, x, t);
      expect_close(Wide(current / (plus + minus)), mean_velocity(shock, x, t), tiny, "equation (6)");
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
  expect_close(energy(shock, t), Wide(initial_energy(shock) - entered * pow(shock.speed, 2) / 2 + inside), tiny, "(7)");
}

TEST(InelasticProfiles, SlopeTendsToItsSecondLine) {
  // l << u0 t << l/(1-eps): with 1-eps = 1e-12 and tau = (1-eps) u0 t/l, deviations are tau and (1-eps)/(2 tau)
  const auto shock = paper_shock<Wide>(Wide(1 - decimal("1e-12")));
  const Wide early = mean_velocity_slope_early(shock);
  for (const char* digits : {"1e-3", "1e-4", "1e-5"}) {
    const Wide tau = decimal(digits);
    const Wide t = tau * decimal("1e12") / shock.speed;
    expect_close(mean_velocity_slope(shock, t), early, Wide(tau + decimal("1e-12") / tau), digits);
  }
  EXPECT_LE(abs(Wide(mean_velocity_slope_early(paper_shock<Wide>(decimal("0.999"))) + decimal("2.5006e-4"))),
            decimal("5e-9"));
}

TEST(InelasticProfiles, EnergyIsOffTheSimulationAsStated) {
  // N-body energies at eps = .999, N = 8000 (t = 999.5, 1999); the percentages are of the energy lost, to two digits.
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
  // lengths x 2, times x 5, masses x 3: powers of two where equality is asked for
  InelasticShock<double> unit{0.99};
  unit.particles = 200;
  InelasticShock<double> scaled{0.99, 0.5 * 4 / 8, 4, 2, 200};
  EXPECT_EQ(front_position(scaled, 8 * 50.0), 4 * front_position(unit, 50.0));
  EXPECT_EQ(front_velocity(scaled, 8 * 50.0), front_velocity(unit, 50.0) / 2);
  EXPECT_EQ(interaction_density(scaled, 8 * 50.0), interaction_density(unit, 50.0) / 2);
  EXPECT_EQ(mean_velocity_slope(scaled, 8 * 50.0), mean_velocity_slope(unit, 50.0) / 8);
  EXPECT_EQ(mean_velocity_slope_early(scaled), mean_velocity_slope_early(unit) / 8);
  EXPECT_EQ(energy(scaled, 8 * 50.0), energy(unit, 50.0) / 2);
  EXPECT_EQ(sticky_energy(scaled, 8 * 50.0), sticky_energy(unit, 50.0) / 2);
  EXPECT_EQ(*collapse_onset_time(scaled), 8 * *collapse_onset_time(unit));
}

// ---- collapse ----

TEST(Collapse, OnsetReproducesTheReferenceDigits) {
  const std::array<std::array<const char*, 2>, 3> rows{{{"0.999", "6280.04"}, {"0.99", "625.17"}, {"0.9", "59.66"}}};
  for (const auto& [eps, time] : rows) EXPECT_DIGITS(*collapse_onset_time(paper_shock<Wide>(decimal(eps))), time);
  for (int n = 2; n <= 100; n += 7) {
    expect_close(*collapse_onset_bodies(collapse_limit<Wide>(n)), Wide(n), tiny, "inverse of the limit");
  }
  EXPECT_EQ(*collapse_onset_bodies(0.0), 2.0);
}

TEST(Collapse, LimitsReproduceTheReferenceDigits) {
  EXPECT_DIGITS(three_body_collapse_limit<Wide>(), "0.0717967697244908258902146339765105");
  expect_close(collapse_limit<Wide>(3), three_body_collapse_limit<Wide>(), tiny, "three bodies");
  expect_close(collapse_limit<Wide>(4), Wide(3 - 2 * sqrt(Wide(2))), tiny, "four bodies");
  const Wide below = three_body_collapse_limit<Wide>() * (1 - tiny);
  const Wide above = three_body_collapse_limit<Wide>() * (1 + tiny);
  EXPECT_TRUE(collapse_rates(below, checkerboard_coupling(below, 3)));
  EXPECT_FALSE(collapse_rates(above, checkerboard_coupling(above, 3)));
  for (const int n : {3, 4, 5, 12, 100}) {
    const Wide limit = collapse_limit<Wide>(n);
    EXPECT_TRUE(collapse_rates(Wide(limit * (1 - tiny)), checkerboard_coupling(Wide(limit * (1 - tiny)), n)));
    EXPECT_FALSE(collapse_rates(Wide(limit * (1 + tiny)), checkerboard_coupling(Wide(limit * (1 + tiny)), n)));
  }
}

struct ThreeBodies {
  const char* eps;
  const char* time;
  std::array<std::uint64_t, 4> passes;  // collision, counted from 1, at which the gap passes 1e-16, -34, -100, -300
  std::uint64_t frozen;                 // collision at which a clock in double stops advancing
};
const std::array three_bodies{
    ThreeBodies{"0.05", nullptr, {18, 38, 111, 333}, 31},
    ThreeBodies{"0.01", "1.6736937682559527405521559675474991365441632665957", {11, 21, 61, 179}, 12},
    ThreeBodies{"0.0625", "1.7377984054260977582367587110958928498213699562943", {22, 45, 133, 398}, 49}};

TEST(Collapse, ThreeBodiesReproduceTheReferenceDigits) {
  for (const auto& row : three_bodies) {
    const Wide eps = decimal(row.eps);
    // x = (0, 1, 3), v = (1, 0, -1): gaps 1 and 2, both closing at 1
    const auto time = three_body_collapse_time(eps, Wide(1), Wide(1), Wide(2), Wide(1));
    ASSERT_TRUE(time);
    if (row.time != nullptr)
      EXPECT_DIGITS(*time, row.time);
    else
      expect_close(*time, Wide(Wide(12) / 7), tiny, row.eps);
    EXPECT_EQ(*three_body_collapse_time(eps, Wide(2), Wide(1), Wide(1), Wide(1)), *time);
    EXPECT_FALSE(three_body_collapse_time(eps, Wide(1), Wide(1), Wide(1), Wide(1))) << "a triple collision";
    EXPECT_FALSE(three_body_collapse_time(eps, Wide(1), Wide(-1), Wide(2), Wide(0))) << "never meet";
    EXPECT_FALSE(three_body_collapse_time(eps, Wide(1), Wide(1), Wide(2), Wide(-1))) << "the third runs away";
  }
  const auto rates = *collapse_rates(decimal("0.05"), checkerboard_coupling(decimal("0.05"), 3));
  expect_close(rates.plus, decimal("0.4"), tiny, "lam+");
  expect_close(rates.minus, decimal("0.125"), tiny, "lam-");
  EXPECT_FALSE(three_body_collapse_time(decimal("0.08"), Wide(1), Wide(1), Wide(2), Wide(1)));
}

TEST(Collapse, SequencePassesTheGapsAtTheReferenceCollisions) {
  const std::array sizes{Wide("1e-16"), Wide("1e-34"), Wide("1e-100"), Wide("1e-300")};
  for (const auto& row : three_bodies) {
    const Wide eps = decimal(row.eps);
    const Wide limit = *three_body_collapse_time(eps, Wide(1), Wide(1), Wide(2), Wide(1));
    const auto rates = *collapse_rates(eps, checkerboard_coupling(eps, 3));
    CollapseSequence<Wide> sequence(eps, checkerboard_coupling(eps, 3), Wide(1), Wide(1), Wide(1), Wide(1));
    std::array<std::uint64_t, 4> passes{};
    for (int steps = 0; steps < 420; ++steps) {
      for (std::size_t k = 0; k < sizes.size(); ++k) {
        if (passes[k] == 0 && sequence.now().other_gap < sizes[k]) passes[k] = sequence.now().contact + 1;
      }
      const Wide interval = sequence.interval();
      ASSERT_TRUE(sequence.advance());
      ASSERT_LE(sequence.now().time, Wide(limit * (1 + tiny)));
      if (steps > 400)
        expect_close(Wide(sequence.interval() / interval), Wide(rates.minus / rates.plus), tiny, row.eps);
    }
    EXPECT_EQ(passes, row.passes) << row.eps;
    expect_close(sequence.now().time, limit, tiny, row.eps);
  }
}

TEST(Collapse, FourBodiesInTheCheckerboardPattern) {
  // Gaps (1,2,1) all closing at 1. Amplitudes: outer pairs sqrt 2 times the gap, the middle one as it is.
  const auto time = [](const Wide& eps) {
    const Wide coupling = checkerboard_coupling(eps, 4);
    const Wide p0 = sqrt(Wide(2));
    return collapse_time(eps, coupling, Wide(1), p0, Wide(1), Wide(1 + coupling * p0));
  };
  expect_close(*time(decimal("0.15")), Wide(Wide(11) / 7), tiny, "eps = .15");
  // Source: the surd 1 + 1/(2.1 - sqrt 2 lam-) and a plain event-driven run, both at 60 digits. (The validation table
  // has the 20th and 23rd decimals, 4 and 0, interchanged.)
  EXPECT_DIGITS(*time(decimal("0.1")), "1.53471469049059024594590831142126492903216478");
  EXPECT_FALSE(time(decimal("0.18")));
  // coupling: the closed forms for 3 and 4 bodies are the cosine of the others
  const Wide pi = 4 * atan(Wide(1));
  expect_close(checkerboard_coupling(decimal("0.1"), 4), Wide(decimal("1.1") * cos(Wide(pi / 4))), tiny, "n = 4");
  expect_close(checkerboard_coupling(decimal("0.1"), 3), Wide(decimal("1.1") * cos(Wide(pi / 3))), tiny, "n = 3");
}

TEST(Collapse, SequenceThatPartsEnds) {
  const double eps = 0.5;
  CollapseSequence<double> sequence(eps, checkerboard_coupling(eps, 3), 0.0, 1.0, 1.0, 0.0);
  int contacts = 0;
  while (sequence.advance()) ASSERT_LT(++contacts, 100);
  EXPECT_FALSE(sequence.next_closing_speed() > 0);
  EXPECT_FALSE(sequence.advance());
}

// ---- scalars ----

TEST(TheoryScalars, StrictTypeGivesTheBitsOfTheTypeItWraps) {
  const Strict eps = Strict(999) / Strict(1000);
  const Strict t(700);
  InelasticShock<Strict> strict{eps, Strict(1) / Strict(2), Strict(1), Strict(1), 8000};
  const auto wide = paper_shock<Wide>(Wide(Wide(999) / 1000));
  const Wide wide_t(700);
  EXPECT_EQ(front_position(strict, t).wide(), front_position(wide, wide_t));
  EXPECT_EQ(front_velocity(strict, t).wide(), front_velocity(wide, wide_t));
  EXPECT_EQ(turnover_time(strict)->wide(), *turnover_time(wide));
  EXPECT_EQ(maximal_front(strict)->wide(), *maximal_front(wide));
  EXPECT_EQ(turnover_contact(strict)->position.wide(), turnover_contact(wide)->position);
  EXPECT_EQ(front_position_discrete(strict, t).wide(), front_position_discrete(wide, wide_t));
  EXPECT_EQ(interaction_density(strict, t).wide(), interaction_density(wide, wide_t));
  EXPECT_EQ(left_mover_density(strict, Strict(3), t).wide(), left_mover_density(wide, Wide(3), wide_t));
  EXPECT_EQ(left_mover_velocity(strict, Strict(3), t).wide(), left_mover_velocity(wide, Wide(3), wide_t));
  EXPECT_EQ(mean_velocity(strict, Strict(3), t).wide(), mean_velocity(wide, Wide(3), wide_t));
  EXPECT_EQ(mean_velocity_slope_early(strict).wide(), mean_velocity_slope_early(wide));
  EXPECT_EQ(energy(strict, t).wide(), energy(wide, wide_t));
  EXPECT_EQ(sticky_energy(strict, t).wide(), sticky_energy(wide, wide_t));
  EXPECT_EQ(collapse_onset_time(strict)->wide(), *collapse_onset_time(wide));
  FrontRecursion<Strict> recursion(strict);
  recursion.advance();
  EXPECT_LE(abs(recursion.now().position.wide()), tiny);
  const Strict small = Strict(1) / Strict(20);
  const auto time = three_body_collapse_time(small, Strict(1), Strict(1), Strict(2), Strict(1));
  expect_close(time->wide(), Wide(Wide(12) / 7), tiny, "three bodies");
  CollapseSequence<Strict> sequence(small, checkerboard_coupling(small, 5), Strict(0), Strict(1), Strict(1), Strict(1));
  EXPECT_TRUE(sequence.advance());
  EXPECT_TRUE(collapse_limit<Strict>(7) > collapse_limit<Strict>(6));
}

template <class T> class BuiltIn : public testing::Test {};
using BuiltInTypes = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(BuiltIn, BuiltInTypes);

TYPED_TEST(BuiltIn, AgreesWithWideToItsOwnPrecision) {
  using T = TypeParam;
  const T eps = T(999) / T(1000);
  const auto shock = paper_shock<T>(eps);
  const auto wide = paper_shock<Wide>(Wide(eps));
  const Wide few = 30 * Wide(std::numeric_limits<T>::epsilon());
  expect_close(*maximal_front(shock), *maximal_front(wide), few, "x_max");
  expect_close(front_displacement(shock, T(700)), front_displacement(wide, Wide(700)), few, "(5)");
  expect_close(energy(shock, T(700)), energy(wide, Wide(700)), few, "(7)");
  expect_close(*collapse_onset_time(shock), *collapse_onset_time(wide), few, "onset");
  expect_close(three_body_collapse_limit<T>(), three_body_collapse_limit<Wide>(), few, "7 - 4 sqrt 3");
}

}  // namespace theory_test
