// The formulas for the collapse of few particles, and for the time at which a shock collapses.
// Proves: closed forms to all digits of the reference values (evaluated to 40 digits elsewhere); limits of restitution
// from both sides.
#include "cradle/core/theory/inelastic_collapse.hpp"

#include "cradle/core/theory/inelastic_shock.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::inelastic_collapse_test {

using namespace cradle::theory;

// Identities evaluated in Wide: a few hundred roundings of 2^-168, some after factors of up to 1e4.
const Wide tiny = pow(Wide(10), -44);

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

}  // namespace cradle::test::inelastic_collapse_test
