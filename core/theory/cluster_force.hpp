// The force on a heavy cluster of the late wet shock, and what oscillations it makes of it: "Dry and wet granular shock
// waves", section VI, equations (14), (15) and (17).
// Exponents of (17), M x'' = -alpha sgn x with M = m (1 + r t), for r t >> 1: with g = alpha/M it is x'' = -g(t) sgn x,
// a Hamiltonian v^2/2 + g |x| that changes slowly, so the area of the orbit, proportional to u x = sqrt(2 g x) x at
// amplitude x, is an adiabatic invariant: x ~ g^(-1/3) ~ t^(1/3), omega ~ sqrt(g/x) ~ t^(-2/3), u ~ sqrt(g x) ~
// t^(-1/3), M u^2 ~ t^(1/3). If the mass were taken up at rest, d(M x')/dt = -alpha sgn x, the invariant would be M u x
// and the oscillations would die out, x ~ t^(-1/3): the paper's exponents are those of M x''.
#pragma once

#include "cradle/core/theory/wet_zone.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <span>

namespace cradle::theory {

/// Exponents of time of amplitude, frequency, speed and energy in equation (17).
struct OscillationExponents {
  double amplitude = 1. / 3, frequency = -2. / 3, speed = -1. / 3, energy = 1. / 3;
};

/// A force in regions divided by increasing edges, smooth in each of them and a little beyond.
template <class F>
concept PiecewiseForce = requires(const F force, std::size_t region, double x) {
  { force.edges() } -> std::convertible_to<std::span<const double>>;
  { force(region, x) } -> std::same_as<double>;
};

/// Equations (14) and (15): left of the zone, in it, right of it.
class ZoneForce {
 public:
  explicit ZoneForce(const WetZone<double>& zone) : zone_(zone), edges_{-zone.half_width(), zone.half_width()} {}
  std::span<const double> edges() const { return edges_; }
  double operator()(std::size_t region, double x) const {
    if (region == 1) return zone_.inner_force(x);
    return region == 0 ? zone_.row_force() : -zone_.row_force();
  }

 private:
  WetZone<double> zone_;
  std::array<double, 2> edges_;
};

/// Equation (17): -alpha sgn x.
class SignForce {
 public:
  explicit SignForce(double alpha) : alpha_(alpha) {}
  std::span<const double> edges() const { return edges_; }
  double operator()(std::size_t region, double) const { return region == 0 ? alpha_ : -alpha_; }

 private:
  double alpha_;
  std::array<double, 1> edges_{0};
};

}  // namespace cradle::theory
