// A blast in a cold gas at rest, on a line: energy E set free at x = 0, t = 0 in a gas of mass density rho. For hard
// particles on a line (one degree of freedom: gamma = 3) Euler's equations have the self-similar solution of Taylor,
// von Neumann and Sedov, in closed form. With delta = 2/3,
//
//     R = (A E t^2/rho)^(1/3),  xi = x/R,  velocity (delta x/t) V(xi),  density rho G(xi),  pressure = density * theta,
//
// theta = <(v - u)^2> the granular temperature per mass. Energy within xi is constant in time: theta = u^2
// (1-V)/(3V-1). Continuity, (V-1) dlnG + dV + V dln xi = 0, and entropy, D(pressure/density^3) = 0, then give, from V =
// 1/2, G = 2 at the front (strong shock) to V = 1/3 at the centre,
//
//     xi = (6V-2)^(2/5) (2V)^(-2/3) (3-4V)^(-11/15),    G = 2 (2-2V)^2 (6V-2)^(1/5) (3-4V)^(-11/5),
//
// and 1/A = 2 delta^2 int_0^1 xi^2 G (V^2 + V^2 (1-V)/(3V-1))/2 dxi: A = 1071/152 (found in arXiv:2010.15868; the
// quadrature is in tests/core/theory/classics_test.cpp). Derived here, with the source's profiles. Units of the scene.
#pragma once

#include <algorithm>
#include <cmath>

namespace cradle::theory {

/// A, of R^3 = A E t^2/rho.
inline constexpr double blast_amplitude = 1071.0 / 152;

struct Blast {
  double energy = 1;   ///< E, on both sides together
  double density = 1;  ///< rho, mass per length at rest
};

/// R, t > 0.
inline double blast_front(const Blast& blast, double t) {
  return std::cbrt(blast_amplitude * blast.energy * t * t / blast.density);
}

/// Behind the front: u/(x/t delta), density over that at rest.
struct BlastScaling {
  double velocity, density;
};

/// xi of a V from 1/3 to 1/2.
inline double blast_place(double v) {
  return std::pow(6 * v - 2, 2.0 / 5) * std::pow(2 * v, -2.0 / 3) * std::pow(3 - 4 * v, -11.0 / 15);
}

/// V and G at 0 <= xi <= 1, by bisection; xi grows with V.
inline BlastScaling blast_scaling(double xi) {
  double below = 1.0 / 3, above = 0.5;
  for (int k = 0; k < 60; ++k) {
    const double middle = (below + above) / 2;
    (blast_place(middle) < xi ? below : above) = middle;
  }
  const double v = above, left = std::max(0.0, 6 * v - 2);
  return {v, 2 * std::pow(2 - 2 * v, 2) * std::pow(left, 1.0 / 5) * std::pow(3 - 4 * v, -11.0 / 5)};
}

/// A gas at a place |x| <= R; mass density, velocity, and temperature per mass <(v - u)^2>.
struct BlastState {
  double density, velocity, temperature;
};
inline BlastState blast_state(const Blast& blast, double x, double t) {
  const BlastScaling s = blast_scaling(std::abs(x) / blast_front(blast, t));
  const double u = 2 * x / (3 * t) * s.velocity;
  return {blast.density * s.density, u, u * u * (1 - s.velocity) / (3 * s.velocity - 1)};
}

}  // namespace cradle::theory
