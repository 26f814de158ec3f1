// The sticky shock: two rows, rho_l at u_l on the left and rho_r at u_r on the right, run into a particle of mass m_0
// and velocity u_c between them, at x = 0 and t = 0; all that arrives sticks. "Dry and wet granular shock waves",
// section II, Fig. 1, for the general Riemann data given there. With the absorbed masses A_l = rho_l (u_l t - X) and
// A_r = rho_r (X - u_r t), mass, momentum and moment of the cluster at X(t) are those of what it took in:
//     M = m_0 + A_l + A_r,   M X = m_0 u_c t + (rho_l (u_l^2 t^2 - X^2) + rho_r (X^2 - u_r^2 t^2))/2 ,
// a quadratic equation for X. In the frame of u_c, with w_l = u_l - u_c >= 0, w_r = u_c - u_r >= 0, w = w_l + w_r,
//     M^2 = m_0^2 + 2 m_0 t (rho_l w_l + rho_r w_r) + rho_l rho_r w^2 t^2,
//     X = u_c t + q t^2/B,   V = P/M = u_c + q t (m_0 + M)/(M B),
//     q = rho_l w_l^2 - rho_r w_r^2,   B = m_0 + (rho_l w_l + rho_r w_r) t + M,
//     A_l = rho_l t [w_l (m_0 + M) + rho_r w_r w t]/B,   A_r likewise.
// All sums have positive terms; q is a product of a difference and a sum of square roots. Equal densities: M = m_0 +
// rho (u_l - u_r) t, the weak solution of Fig. 1. The energy lost is the energy relative to V of all that has stuck.
// Units: lengths, times and masses of the scene; densities are mass per length. T is a Real.
#pragma once

#include <stdexcept>

#include "cradle/core/base/real.hpp"

namespace cradle::theory {

/// Riemann data: densities > 0, u_l >= u_c >= u_r, u_l > u_r, m_0 >= 0. Without a particle, m_0 = 0, u_c means nothing.
template <class T> struct StickyShock {
  T density_left;     ///< rho_l
  T velocity_left;    ///< u_l
  T density_right;    ///< rho_r
  T velocity_right;   ///< u_r
  T mass = T(0);      ///< m_0
  T velocity = T(0);  ///< u_c
};

/// The cluster at one time, and what it has done until then.
template <class T> struct StickyCentre {
  T mass;         ///< M
  T position;     ///< X
  T velocity;     ///< V = dX/dt
  T from_left;    ///< A_l
  T from_right;   ///< A_r
  T energy_lost;  ///< E(0) - E(t)
};

/// Rate at which the mass grows, late or with m_0 = 0: sqrt(rho_l rho_r) (u_l - u_r).
template <class T> T late_growth(const StickyShock<T>& shock) {
  return T(square_root(shock.density_left) * square_root(shock.density_right) *
           (shock.velocity_left - shock.velocity_right));
}

/// Velocity of the cluster, late or with m_0 = 0: (sqrt rho_l u_l + sqrt rho_r u_r)/(sqrt rho_l + sqrt rho_r).
template <class T> T late_velocity(const StickyShock<T>& shock) {
  const T left = square_root(shock.density_left);
  const T right = square_root(shock.density_right);
  return T((left * shock.velocity_left + right * shock.velocity_right) / (left + right));
}

/// Energy lost per time, late or with m_0 = 0: rho_l rho_r (u_l - u_r)^3/[2 (sqrt rho_l + sqrt rho_r)^2]; rho_0 u_0^3
/// for equal rows (section IV).
template <class T> T late_power(const StickyShock<T>& shock) {
  const T roots = square_root(shock.density_left) + square_root(shock.density_right);
  const T closing = shock.velocity_left - shock.velocity_right;
  const T growth = late_growth(shock);
  return T(growth * growth * closing / (T(2) * roots * roots));
}

/// The cluster at time t >= 0, while neither row is used up. Throws std::domain_error for data other than the above.
template <class T> StickyCentre<T> sticky_centre(const StickyShock<T>& shock, const T& t) {
  const T& m0 = shock.mass;
  const T& u_l = shock.velocity_left;
  const T& u_r = shock.velocity_right;
  if (!(shock.density_left > T(0) && shock.density_right > T(0)) || m0 < T(0))
    throw std::domain_error("a density of the sticky shock is not positive, or its central mass negative");
  // Without a particle any u_c between the rows does; with that of the cluster, q vanishes.
  const T u_c = m0 > T(0) ? shock.velocity : late_velocity(shock);
  if (!(u_l > u_r) || u_c > u_l || u_c < u_r)
    throw std::domain_error("the sticky shock needs rows that close in on what is between them");
  if (!(m0 > T(0)) && !(t > T(0))) return {T(0), T(0), u_c, T(0), T(0), T(0)};

  const T w_l = u_l - u_c;
  const T w_r = u_c - u_r;
  const T w = u_l - u_r;
  const T left = square_root(shock.density_left);
  const T right = square_root(shock.density_right);
  const T q = (left * w_l - right * w_r) * (left * w_l + right * w_r);
  const T met = (shock.density_left * w_l + shock.density_right * w_r) * t;
  const T grown = left * right * w * t;
  const T mass = square_root(T(m0 * m0 + T(2) * m0 * met + grown * grown));
  const T sum = m0 + met + mass;
  const T velocity = u_c + q * t * (m0 + mass) / (mass * sum);
  const T from_left = shock.density_left * t * (w_l * (m0 + mass) + shock.density_right * w_r * w * t) / sum;
  const T from_right = shock.density_right * t * (w_r * (m0 + mass) + shock.density_left * w_l * w * t) / sum;
  const T slip_c = u_c - velocity;
  const T slip_l = u_l - velocity;
  const T slip_r = velocity - u_r;
  const T lost = (m0 * slip_c * slip_c + from_left * slip_l * slip_l + from_right * slip_r * slip_r) / T(2);
  return {mass, T(u_c * t + q * t * t / sum), velocity, from_left, from_right, lost};
}

}  // namespace cradle::theory
