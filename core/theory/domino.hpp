// A row of dominoes (arXiv:2605.16125): particles of masses m, mu, m, mu, ... at rest, a spacing a apart, the first
// one, of mass m, kicked with speed u; all collisions elastic. A heavy particle, the light one beside it and the next
// heavy one are a point that moves in a wedge: in gaps scaled by masses its sides meet at the angle alpha, cos alpha =
// m/(m + mu). If alpha = pi/(2k+1), that is c = cos alpha, m/mu = c/(1-c), the point leaves the wedge in one direction
// whatever the place it came in: after 2k collisions the first two particles are at rest and the third has all of the
// momentum. So the front moves from heavy particle to heavy particle at the speed u, for ever, and particle n = 0, 2,
// 4, ... is first hit when the light one before it, at 2 c u after its first collision, has come from n-1 to n:
//
//     t_n = (n - 1 + 1/(2c)) a/u = (n - c_k) a/u,    c_k = 0, 0.381966, 0.445042, 0.467911 for k = 1, 2, 3, 4.
//
// Derived here; the same ratios and delays as the source's.
#pragma once

#include <cmath>

namespace cradle::theory {

/// c = m/(m + mu): half of a light particle's speed after its first collision, in units of the kick's speed.
template <class T> T domino_cosine(const T& heavy, const T& light) { return T(heavy / (heavy + light)); }

/// The k for which the front is ballistic, pi/alpha = 2k + 1, if k is whole to one part in 2^20; else 0.
inline int domino_order(double heavy, double light) {
  const double turns = 3.141592653589793 / std::acos(domino_cosine(heavy, light));
  const double k = std::floor(turns / 2);
  return k >= 1 && std::abs(turns - (2 * k + 1)) < 0x1p-20 * turns ? static_cast<int>(k) : 0;
}

/// The time at which a ballistic front first hits particle n, even and > 0, in spacings per speed of the kick.
template <class T> T domino_time(const T& heavy, const T& light, int n) {
  return T(T(n - 1) + T(1) / (T(2) * domino_cosine(heavy, light)));
}

}  // namespace cradle::theory
