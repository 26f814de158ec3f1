// Free cooling of one-dimensional gases from independent velocities of variance s^2, n particles of mass m per length.
// Sticky gas: the energy of an inviscid Burgers turbulence, per particle
//     E/N = m C_E s^{4/3} n^{-2/3} t^{-2/3},  clusters/N = C_n (s n t)^{-2/3},    C_E = 0.2213762..., C_n =
//     1.3282573...
// for s n t >> 1 (Frachebourg, Phys. Rev. Lett. 82, 1502 (1999), doi 10.1103/PhysRevLett.82.1502; white-noise initial
// velocities). The paper claims the same law for all three gases (section I, VI).
// Inelastic gas, early: homogeneous, Gaussian velocities (Haff, J. Fluid Mech. 134, 401 (1983),
// doi 10.1017/S0022112083003419). A particle meets others at the rate 2 n s/sqrt(pi); a collision costs
// mu <w^3>/<w> (1 - eps^2)/2 = m s^2 (1 - eps^2), shared by two, so that
//     ds/dt = -n (1 - eps^2) s^2/sqrt(pi),   E = E_0/(1 + t/tau)^2,   tau = sqrt(pi)/(n (1 - eps^2) s_0).
// Units of the scene.
#pragma once

#include <cmath>
#include <stdexcept>

namespace cradle::theory {

/// C_E and C_n.
inline constexpr double sticky_cooling_energy = 0.221376226650747359;
inline constexpr double sticky_cooling_clusters = 1.32825735990448415;

struct FreeCooling {
  double variance = 1;  ///< s^2
  double density = 1;   ///< n, particles per length
  double mass = 1;      ///< m
};

/// Energy per particle of the sticky gas, t > 0.
inline double sticky_energy_per_particle(const FreeCooling& gas, double t) {
  return gas.mass * sticky_cooling_energy * gas.variance *
         std::pow(std::sqrt(gas.variance) * gas.density * t, -2.0 / 3);
}

/// Clusters per particle of the sticky gas, t > 0.
inline double sticky_clusters_per_particle(const FreeCooling& gas, double t) {
  return sticky_cooling_clusters * std::pow(std::sqrt(gas.variance) * gas.density * t, -2.0 / 3);
}

/// Haff's time tau; throws std::domain_error for an elastic gas.
inline double haff_time(const FreeCooling& gas, double restitution) {
  if (!(restitution < 1)) throw std::domain_error("an elastic gas does not cool");
  constexpr double root_pi = 1.7724538509055160;
  return root_pi / (gas.density * (1 - restitution) * (1 + restitution) * std::sqrt(gas.variance));
}

/// Energy per particle by Haff's law.
inline double haff_energy_per_particle(const FreeCooling& gas, double restitution, double t) {
  const double slowed = restitution < 1 ? 1 + t / haff_time(gas, restitution) : 1;
  return gas.mass * gas.variance / (2 * slowed * slowed);
}

}  // namespace cradle::theory
