// A splash: a gas at rest at x > 0, vacuum at x < 0, kicked at its surface (impulsive load; for hard particles on a
// line, of alternate masses, arXiv:2203.11097). The shock goes as R ~ t^d, what is left in the gas as E ~ R^3/t^2 ~
// t^(3d-2), with an exponent that does not follow from dimensions: a self-similar solution of the second kind. With xi
// = x/R, velocity R' U(xi), density rho G(xi), pressure rho R'^2 P(xi), k = (d - 1)/d and a = U - xi, Euler's equations
// are
//
//     U' = k (gamma a U - 2 c^2)/(gamma (c^2 - a^2)),  G' = -G U'/a,  P' = -G (k U + a U'),   c^2 = gamma P/G,
//
// from the strong shock U = P = 2/(gamma+1), G = (gamma+1)/(gamma-1) at xi = 1 towards -infinity. Too small a d ends
// where c^2 = a^2, with an infinite slope; from a critical one on there is no such place, and at that one the solution
// passes through it smoothly: this is the d. It is 3/5 exactly for gamma = 7/5; for gamma = 3, particles on a line,
// 0.6279520417, and the energy's exponent -0.116143875.
//
// With d xi/ds = -gamma (c^2 - a^2) the equations have no infinite slope, and 1 - a^2/c^2 falls along s up to 0 for too
// small a d, to a least value above 0 for too large a one.
#pragma once

#include <array>

namespace cradle::theory {

namespace detail {

// Whether the solution of this exponent runs into c^2 = a^2; in steps of s by Runge and Kutta's fourth order.
inline bool splash_breaks_off(double d, double gamma, double step) {
  using State = std::array<double, 4>;  // xi, U, G, P
  const double k = (d - 1) / d;
  const auto slope = [k, gamma](const State& y) -> State {
    const double a = y[1] - y[0], c2 = gamma * y[3] / y[2];
    const double along = gamma * (c2 - a * a), u = k * (gamma * a * y[1] - 2 * c2);
    return {-along, -u, y[2] * u / a, y[2] * (k * y[1] * along + a * u)};
  };
  const auto moved = [](const State& y, const State& by, double h) -> State {
    return {y[0] + h * by[0], y[1] + h * by[1], y[2] + h * by[2], y[3] + h * by[3]};
  };
  State y{1, 2 / (gamma + 1), (gamma + 1) / (gamma - 1), 2 / (gamma + 1)};
  for (double before = 1;;) {
    const State k1 = slope(y), k2 = slope(moved(y, k1, step / 2)), k3 = slope(moved(y, k2, step / 2)),
                k4 = slope(moved(y, k3, step));
    for (std::size_t i = 0; i < 4; ++i) y[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    const double a = y[1] - y[0], subsonic = 1 - a * a * y[2] / (gamma * y[3]);
    if (!(subsonic > 0)) return true;
    if (!(subsonic < before)) return false;
    before = subsonic;
  }
}

}  // namespace detail

/// d of R ~ t^d, for gamma from 1.2 to 3. The error falls with the fourth power of the step: 6e-11 for gamma = 3.
inline double splash_front_exponent(double gamma = 3, double step = 0.0025) {
  double below = 0.55, above = 2.0 / 3;  // 2/3: of a shock whose energy is kept
  for (int halvings = 0; halvings < 48; ++halvings) {
    const double d = (below + above) / 2;
    (detail::splash_breaks_off(d, gamma, step) ? below : above) = d;
  }
  return above;
}

/// Of the energy left in the gas.
inline double splash_energy_exponent(double gamma = 3) { return 3 * splash_front_exponent(gamma) - 2; }

}  // namespace cradle::theory
