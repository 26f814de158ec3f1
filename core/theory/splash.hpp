// A splash: a gas at rest at x > 0, vacuum at x < 0, kicked at its surface (impulsive load; for hard bodies on a line,
// of alternate masses, arXiv:2203.11097). The shock goes as R ~ t^d, what is left in the gas as E ~ R^3/t^2 ~ t^(3d-2),
// with an exponent that no dimension tells: a self-similar solution of the second kind. With xi = x/R, velocity R'
// U(xi), density rho G(xi), pressure rho R'^2 P(xi), k = (d - 1)/d and a = U - xi, Euler's equations are
//
//     U' = k (gamma a U - 2 c^2)/(gamma (c^2 - a^2)),  G' = -G U'/a,  P' = -G (k U + a U'),   c^2 = gamma P/G,
//
// from the strong shock U = P = 2/(gamma+1), G = (gamma+1)/(gamma-1) at xi = 1 towards -infinity. Too small a d ends
// where c^2 = a^2, with an infinite slope; from a critical one on there is no such place, and at that one the solution
// passes through it smoothly: this is the d. It is 3/5 exactly for gamma = 7/5; for gamma = 3, bodies on a line,
// .627952, and the energy's exponent -.116144. Derived here; the published values, .62906 and -.11281, are not these.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace cradle::theory {

namespace detail {

// Whether the solution of this exponent runs into c^2 = a^2.
inline bool splash_breaks_off(double d, double gamma) {
  using State = std::array<double, 3>;  // U, G, P
  const double k = (d - 1) / d;
  const auto subsonic = [gamma](double xi, const State& y) {  // 1 - a^2/c^2
    const double a = y[0] - xi;
    return 1 - a * a * y[1] / (gamma * y[2]);
  };
  const auto slope = [k, gamma](double xi, const State& y) -> State {
    const double a = y[0] - xi, c2 = gamma * y[2] / y[1];
    const double u = k * (gamma * a * y[0] - 2 * c2) / (gamma * (c2 - a * a));
    return {u, -y[1] * u / a, -y[1] * (k * y[0] + a * u)};
  };
  const auto moved = [](const State& y, const State& by, double h) -> State {
    return {y[0] + h * by[0], y[1] + h * by[1], y[2] + h * by[2]};
  };
  State y{2 / (gamma + 1), (gamma + 1) / (gamma - 1), 2 / (gamma + 1)};
  for (double xi = 1; xi > -3;) {  // Runge and Kutta's fourth order, in steps that shrink towards the place
    const double h = -(1 + std::abs(xi)) * std::min(1e-3, 1e-2 * subsonic(xi, y)) - 1e-10;
    const State k1 = slope(xi, y), k2 = slope(xi + h / 2, moved(y, k1, h / 2)),
                k3 = slope(xi + h / 2, moved(y, k2, h / 2)), k4 = slope(xi + h, moved(y, k3, h));
    for (std::size_t i = 0; i < 3; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    xi += h;
    if (!(subsonic(xi, y) > 1e-9)) return true;
  }
  return false;
}

}  // namespace detail

/// d of R ~ t^d, for gamma from 1.2 to 3.
inline double splash_front_exponent(double gamma = 3) {
  double below = 0.55, above = 2.0 / 3;  // 2/3: of a shock whose energy is kept
  for (int halvings = 0; halvings < 24; ++halvings) {
    const double d = (below + above) / 2;
    (detail::splash_breaks_off(d, gamma) ? below : above) = d;
  }
  return above;
}

/// Of the energy left in the gas.
inline double splash_energy_exponent(double gamma = 3) { return 3 * splash_front_exponent(gamma) - 2; }

}  // namespace cradle::theory
