// Free cooling of one-dimensional gases from independent velocities of variance s^2, n particles of mass m per length.
// Sticky gas: the energy of an inviscid Burgers turbulence, per particle
//     E/N = m C_E s^{4/3} n^{-2/3} t^{-2/3},  clusters/N = C_n (s n t)^{-2/3},    C_E = 0.2213762..., C_n =
//     1.3282573...
// for s n t >> 1 (Frachebourg, Phys. Rev. Lett. 82, 1502 (1999), doi 10.1103/PhysRevLett.82.1502; white-noise initial
// velocities). The paper claims the same law for all three gases (section I, VI).
// Inelastic gas, early: homogeneous, Gaussian velocities (Haff, J. Fluid Mech. 134, 401 (1983),
// doi 10.1017/S0022112083003419). A particle meets others at the rate 2 n s/sqrt(pi); a collision costs
// mu <w^3>/<w> (1 - eps^2)/2 = m s^2 (1 - eps^2), shared by two, so that
//     ds/dt = -n (1 - eps^2) s^2/sqrt(pi),   E = E_0/(1 + t/tau)^2,   tau = sqrt(pi)/(n (1 - eps^2) s_0),
// and, as two particles share a collision, N n s/sqrt(pi) collisions per time: N ln(1 + t/tau)/(1 - eps^2) up to t. The
// elastic limit, N n s t/sqrt(pi), is exact: particles that pass through each other meet as often. Haff's law neglects
// correlations. It ends where particles cluster, about where its energy falls below that of the sticky gas.
// A particle meets N - 1 others. On a ring, N particles without total momentum have N - 1 degrees of freedom, E_0 =
// (N - 1) m s^2/2: the laws of energy and of collisions per particle hold with N - 1 for N, and n = N/L. Between walls
// they hold with N, and n = (N - 1)/L.
// Units of the scene.
#pragma once

#include <cmath>
#include <numbers>
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
  return 1 / std::numbers::inv_sqrtpi / (gas.density * (1 - restitution) * (1 + restitution) * std::sqrt(gas.variance));
}

/// Energy per particle by Haff's law.
inline double haff_energy_per_particle(const FreeCooling& gas, double restitution, double t) {
  const double slowed = restitution < 1 ? 1 + t / haff_time(gas, restitution) : 1;
  return gas.mass * gas.variance / (2 * slowed * slowed);
}

/// Collisions per particle up to t by Haff's law; restitution 1: exact on the average over places at random.
inline double haff_collisions_per_particle(const FreeCooling& gas, double restitution, double t) {
  if (!(restitution < 1)) return gas.density * std::sqrt(gas.variance) * t * std::numbers::inv_sqrtpi;
  return std::log1p(t / haff_time(gas, restitution)) / ((1 - restitution) * (1 + restitution));
}

/// The time at which Haff's energy falls below that of the sticky gas, restitution < 1: the larger root of
/// 1 + k z^3 = z/sqrt(2 C_E) with z^3 = s n t, k z^3 = t/tau. It has none if eps < 0.33: then where they are closest.
inline double clustering_time(const FreeCooling& gas, double restitution) {
  const double flights = 1 / (gas.density * std::sqrt(gas.variance)), k = flights / haff_time(gas, restitution),
               slope = 1 / std::sqrt(2 * sticky_cooling_energy);
  const double closest = std::sqrt(slope / (3 * k));
  double z = 2 * closest;  // beyond the larger root, since k z^3 - slope z >= 0 from sqrt(3) of it on: Newton descends
  for (int step = 0; step < 60 && z > closest; ++step) z -= (1 + (k * z * z - slope) * z) / (3 * k * z * z - slope);
  z = z > closest ? z : closest;
  return flights * z * z * z;
}

/// Collisions per time, those with walls included, of N elastic particles of mass m between walls of the temperatures
/// T_1, T_2 at a distance L, after many passages. Particles that pass through each other leave wall i with the density
/// v exp(-m v^2/2 T_i): half Gaussians of deviation s_i = sqrt(T_i/m), densities n_1 s_1 = n_2 s_2 by equal fluxes. The
/// mean |v - v'| is (2 - sqrt 2)(2/sqrt pi) s_i within one half, sqrt(2/pi)(s_1 + s_2) between the two. There are
/// N (N - 1)/2 pairs.
inline double heated_collision_rate(double particles, double length, double s1, double s2) {
  const double n = particles / length, n1 = n * s2 / (s1 + s2), n2 = n - n1,
               root = std::numbers::sqrt2 * std::numbers::inv_sqrtpi,  // sqrt(2/pi)
      within = (std::numbers::sqrt2 - 1) * root * (n1 * n1 * s1 + n2 * n2 * s2);
  return length * (within + n1 * n2 * root * (s1 + s2)) * (1 - 1 / particles) + 2 * n1 * s1 * root;
}

}  // namespace cradle::theory
