// Inelastic collapse of few particles: infinitely many collisions in a finite time.
// In the checkerboard pattern of n equal particles every second gap closes at once, then the others, in turn;
// mirror-symmetric data of 3 or 4 particles always are of this form, with gaps and closing speeds in proportion to
// sin(pi k/n), k = 1 .. n-1. p_j: amplitude of the closing speeds of the gaps that close at collision j (length/time);
// g_j: amplitude of the other gaps at that moment (length); eps: restitution; a = (1+eps) cos(pi/n), the coupling. With
// n = 3 both amplitudes may be read as the plain closing speed and gap. Then
//     p_{j+1} = a p_j - eps p_{j-1},   g_j p_j = eps^j g_0 p_0,   lam+- = (a +- sqrt(a^2 - 4 eps))/2 .
// Sources: three particles: McNamara and Young, Phys. Fluids A 4, 496 (1992); n particles: Bernu and Mazighi,
// J. Phys. A 23, 5745 (1990). Section II of "Dry and wet granular shock waves" meets it as the need for a cut-off.
#pragma once

#include <cmath>
#include <optional>

#include "cradle/core/base/real.hpp"

namespace cradle::theory {

/// Factors per collision of a collapse: closing speeds shrink by `plus`, gaps by `minus`, intervals by minus/plus.
template <class T> struct CollapseRates { T plus, minus; };

/// Coupling a of n = `particles` equal particles in the checkerboard pattern; of 2 to 4 exact up to one square root.
template <class T> T checkerboard_coupling(const T& restitution, int particles) {
  using std::atan;
  using std::cos;
  const T sum = T(1) + restitution;
  if (particles == 2) return T(0);
  if (particles == 3) return T(sum / T(2));
  if (particles == 4) return T(sum / square_root(T(2)));
  const T angle = T(4) * atan(T(1)) / T(particles);
  return T(sum * cos(angle));
}

/// lam+ and lam- for a coupling; none where they are complex, that is, where the pattern disperses instead of
/// collapsing, and none for restitution 0 with coupling 0 (two particles).
template <class T> std::optional<CollapseRates<T>> collapse_rates(const T& restitution, const T& coupling) {
  const T discriminant = coupling * coupling - T(4) * restitution;
  if (discriminant < T(0) || !(coupling > T(0))) return std::nullopt;
  const T plus = (coupling + square_root(discriminant)) / T(2);
  return CollapseRates<T>{plus, T(restitution / plus)};  // lam+ lam- = eps: the difference of the roots would cancel
}

/// Largest restitution at which n = `particles` equal particles collapse in the checkerboard pattern: tan^2[(pi/4)(1 -
/// 2/n)], 7 - 4 sqrt 3 = 0.0718 of three.
template <class T> T collapse_limit(int particles) {
  const T cosine = checkerboard_coupling(T(0), particles);  // tan(pi/4 - b) = cos 2b / (1 + sin 2b) with 2b = pi/n
  const T tangent = cosine / (T(1) + square_root(T((T(1) - cosine) * (T(1) + cosine))));
  return T(tangent * tangent);
}

/// Number of equal particles from which a gas of this restitution collapses, N_c = 2/(1 - (4/pi) atan sqrt eps), a real
/// number; about 2 pi/(1 - eps) near eps = 1. None for eps = 1. Inverse of `collapse_limit`.
template <class T> std::optional<T> collapse_onset_particles(const T& restitution) {
  using std::atan;
  if (!(restitution < T(1))) return std::nullopt;
  const T root = T(1) + square_root(restitution);
  // pi/4 - atan sqrt eps as one arc tangent: nothing cancels as eps -> 1
  const T angle = atan(T((T(1) - restitution) / (root * root)));
  return T(T(2) * atan(T(1)) / angle);
}

/// McNamara and Young's estimate of how many particles stop one that runs into them, N = ln(4/(1-eps))/(1-eps): of a
/// gas between walls that collapses, N_c = 36.9, 87.6, 599 at eps = 0.9, 0.95, 0.99. eps < 1.
inline double cushion_particles(double restitution) {
  using std::log;
  return log(4 / (1 - restitution)) / (1 - restitution);
}

/// Time of collapse, t_c = t_0 + g_0/(p_1 - lam- p_0), after a collision at `t0`, where gaps that close at `p0` touch,
/// the others are `g0` wide and close at `p1` after it: the collision times telescope. None where there is no collapse:
/// the roots are complex (eps too large) or p_1 <= lam- p_0 (the particles part after finitely many collisions).
template <class T>
std::optional<T> collapse_time(const T& restitution, const T& coupling, const T& t0, const T& p0, const T& g0,
                               const T& p1) {
  const auto rates = collapse_rates(restitution, coupling);
  if (!rates) return std::nullopt;
  const T excess = p1 - rates->minus * p0;
  if (!(excess > T(0))) return std::nullopt;
  return T(t0 + g0 / excess);
}

}  // namespace cradle::theory
