// Energy of the wet shock before anything sticks.
// Proves: the recursion over all pairs makes the collisions of an independent event-driven N-particle run (NB: counts
// that double, binary128 and 100 digits agree in), with the front as its first row and the elastic gas as its limit;
// the series follows from its continuous form, in exact rationals; and it gives the run's energy up to the terms that
// it leaves out.
#include "cradle/core/theory/wet_energy.hpp"

#include <map>
#include <utility>

#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/core/wet_reference.hpp"

namespace cradle::test::wet_energy_test {

using namespace cradle::theory;

struct Counted {
  std::uint64_t collisions = 0;
  std::optional<double> end;
};
Counted crossings(double loss, std::uint64_t particles, double t) {
  Counted counted;
  counted.end = cross_rows(paper_shock(loss, particles), t,
                           [&](double, int pairs) { counted.collisions += static_cast<std::uint64_t>(pairs); });
  return counted;
}

TEST(WetEnergy, RecursionCountsTheCollisionsOfARun) {
  // NB. Their particles are displaced by up to 2^-11, which moves a collision in time by as much over u0.
  EXPECT_EQ(crossings(1e-4, 50000, 2000).collisions, 1724590U);
  const auto early = crossings(1e-4, 50000, 4999 - 0.002), late = crossings(1e-4, 50000, 4999 + 0.002);
  EXPECT_LE(early.collisions, 7682229U);
  EXPECT_GE(late.collisions, 7682229U);
  EXPECT_LE(late.collisions - early.collisions, 10U);
  EXPECT_EQ(crossings(0.01, 200, 20).collisions, 171U);
  EXPECT_FALSE(late.end) << "nothing has stuck";
  // and they are the energy: 6250 - 6077.541, 6250 - 5481.7771
  EXPECT_NEAR(1e-4 * 1724590, 6250 - 6077.541, 5e-10);
  EXPECT_NEAR(1e-4 * 7682229, 6250 - 5481.7771, 5e-10);
}

TEST(WetEnergy, RecursionEndsWhereTheFirstPairSticks) {
  // NB: merges seen at t = 6000, none at 4999 (E = 1e-4); 11 at t = 55, none at 20 (E = 0.01)
  const auto fig6 = crossings(1e-4, 50000, 6000);
  ASSERT_TRUE(fig6.end);
  EXPECT_GT(*fig6.end, 4999);
  const auto small = crossings(0.01, 200, 55);
  ASSERT_TRUE(small.end);
  EXPECT_GT(*small.end, 20);
}

TEST(WetEnergy, FirstRowOfTheRecursionIsTheFront) {
  const auto shock = paper_shock(0.01, 20);
  std::vector<double> times;
  // row i = 0 is visited first: its collisions, then those of the others
  cross_rows(shock, 16.0, [&](double t, int) { times.push_back(t); });
  WetFrontRecursion<double> front(shock);
  for (std::size_t n = 0; n < 10; ++n) {
    ASSERT_TRUE(front.advance());
    EXPECT_NEAR(times[n], front.now().time, 100 * ulp * front.now().time) << n;
  }
}

TEST(WetEnergy, RecursionWithoutLossIsTheElasticGas) {
  // K (K + 1)/2, K = 2 u0 t/l (exact), until the rows of 30 have passed: all pairs have met
  for (const int k : {1, 2, 7, 30})
    EXPECT_EQ(crossings(0, 60, k + 0.5).collisions, static_cast<std::uint64_t>(k * (k + 1) / 2));
  EXPECT_EQ(crossings(0, 60, 1000).collisions, 900U);
  EXPECT_EQ(wet_collisions(paper_shock(0.0), 1000.0), 500000.0);
}

TEST(WetEnergy, LawIsThatOfTheRunUpToAFewLossesOverTheEnergy) {
  // e/u0^2 = 4e-4; NB counts
  EXPECT_NEAR(wet_collisions(paper_shock(1e-4), 2000.0) / 1724590, 1, 4e-4);
  EXPECT_NEAR(wet_collisions(paper_shock(1e-4), 4999.0) / 7682229, 1, 4e-4);
  const auto shock = paper_shock(1e-4, 50000);
  EXPECT_NEAR(energy(shock, 2000.0), 6077.541, 4e-4 * 172.459);
  EXPECT_NEAR(energy(shock, 4999.0), 5481.7771, 4e-4 * 768.2229);
  EXPECT_EQ(energy(shock, 0.0), 6250.0);
  // and it converges: the recursion at s = 1 for ever smaller losses (the cut of the series is 4e-5)
  for (const double loss : {1e-2, 1e-3, 1e-4}) {
    const double t = 0.5 / loss;
    const auto counted = crossings(loss, static_cast<std::uint64_t>(2 * t), t);
    EXPECT_NEAR(static_cast<double>(counted.collisions) / wet_collisions(paper_shock(loss), t), 1, loss / 0.25 + 4e-5)
        << loss;
  }
}

// The series, derived anew in exact rationals. Units e = u0 = l = 1. Polynomials in i and j by powers; phi is the
// potential of the speeds, u = phi_i, v = phi_j, which u_j = v_i allows.
using Polynomial = std::map<std::pair<int, int>, Rational>;

void add_product(Polynomial& sum, const Polynomial& a, const Polynomial& b, const Rational& factor) {
  for (const auto& [m, x] : a)
    for (const auto& [n, y] : b) sum[{m.first + n.first, m.second + n.second}] += factor * x * y;
}
Polynomial derivative(const Polynomial& p, bool by_i) {
  Polynomial result;
  for (const auto& [m, x] : p) {
    const int power = by_i ? m.first : m.second;
    if (power > 0) result[{m.first - (by_i ? 1 : 0), m.second - (by_i ? 0 : 1)}] = x * power;
  }
  return result;
}
// What has the mixed second derivative p and vanishes on both axes.
Polynomial twice_integrated(const Polynomial& p) {
  Polynomial result;
  for (const auto& [m, x] : p) result[{m.first + 1, m.second + 1}] = x / ((m.first + 1) * (m.second + 1));
  return result;
}
// Integral over i + j = 1 by i.
Rational over_the_simplex(const Polynomial& p) {
  const auto factorial = [](int n) {
    Rational product(1);
    for (int k = 2; k <= n; ++k) product *= k;
    return product;
  };
  Rational sum(0);
  for (const auto& [m, x] : p) sum += x * factorial(m.first) * factorial(m.second) / factorial(m.first + m.second + 1);
  return sum;
}

TEST(WetEnergy, SeriesFollowsFromTheEquations) {
  constexpr int order = 16;
  // homogeneous parts by degree: phi, t; w = u + v; A = phi_ij from w A = -1; B = t_ij from w B = -(u_i t_j + v_j t_i)
  std::vector<Polynomial> phi(order + 3), w(order + 2), a(order + 1), t(order + 3), b(order + 1);
  std::vector<Rational> inverse(order + 2), on_axis(order + 3);  // 1/w and t on an axis: dt/dj = 1/w
  phi[1] = {{{1, 0}, 1}, {{0, 1}, 1}};
  w[0] = {{{0, 0}, 2}};
  for (std::size_t d = 0; d <= order; ++d) {
    a[d] = d == 0 ? Polynomial{{{0, 0}, Rational(-1, 2)}} : Polynomial{};
    for (std::size_t k = 1; k <= d; ++k) add_product(a[d], w[k], a[d - k], Rational(-1, 2));
    phi[d + 2] = twice_integrated(a[d]);
    w[d + 1] = derivative(phi[d + 2], true);
    for (const auto& [m, x] : derivative(phi[d + 2], false)) w[d + 1][m] += x;

    inverse[d] = d == 0 ? Rational(1, 2) : Rational(0);
    for (std::size_t k = 1; k <= d; ++k) inverse[d] -= w[k][{0, static_cast<int>(k)}] * inverse[d - k] / 2;
    on_axis[d + 1] = inverse[d] / static_cast<int>(d + 1);
    t[d + 1][{0, static_cast<int>(d + 1)}] = t[d + 1][{static_cast<int>(d + 1), 0}] = on_axis[d + 1];

    for (std::size_t k = 1; k <= d; ++k) add_product(b[d], w[k], b[d - k], Rational(-1, 2));
    for (std::size_t k = 0; k <= d; ++k) {
      const auto u_i = derivative(derivative(phi[k + 2], true), true);
      const auto v_j = derivative(derivative(phi[k + 2], false), false);
      add_product(b[d], u_i, derivative(t[d - k + 1], false), Rational(-1, 2));
      add_product(b[d], v_j, derivative(t[d - k + 1], true), Rational(-1, 2));
    }
    t[d + 2] = twice_integrated(b[d]);
  }
  // Collisions up to t: the area of {t(i,j) <= t}, the integral of rho^2/2 over directions, i + j = rho. By Lagrange's
  // inversion [t^n] rho^2 = (2/n) [rho^(n-2)] (rho/t)^n, and t/rho = 1/2 (1 + 2 t_2 rho + 2 t_3 rho^2 + ...).
  std::vector<Rational> coefficients;  // of g, collisions over 2 t^2
  for (int k = 0; k <= order; ++k) {
    const int n = k + 2;
    std::vector<Polynomial> power(static_cast<std::size_t>(k) + 1);  // of (1 + ...)^-n
    power[0] = {{{0, 0}, 1}};
    for (int m = 1; m <= k; ++m)
      for (int q = 1; q <= m; ++q)
        add_product(power[static_cast<std::size_t>(m)], t[static_cast<std::size_t>(q + 1)],
                    power[static_cast<std::size_t>(m - q)], Rational(2 * (-n * q - (m - q)), m));
    coefficients.push_back(over_the_simplex(power.back()) * (1 << (n - 1)) / n);
  }
  EXPECT_EQ(coefficients[1], Rational(-1, 3));
  EXPECT_EQ(coefficients[2], Rational(-1, 48));
  EXPECT_EQ(coefficients[3], Rational(-1, 80));
  // Two polynomials of degree 16 that agree in 17 places are the same.
  for (int s = 0; s <= order; ++s) {
    Rational g(0);
    for (std::size_t k = coefficients.size(); k-- > 0;) g = g * s + coefficients[k];
    EXPECT_EQ(collision_share(Rational(s)), g) << s;
  }
}

}  // namespace cradle::test::wet_energy_test
