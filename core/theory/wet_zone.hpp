// The linear model of the late wet shock: a stationary zone |x| < L in which incoming particles are slowed from u0 to
// the critical speed u_crit, and the force it exerts on a heavy cluster. "Dry and wet granular shock waves", section
// VI, equations (9) to (15) and (17), corrected. n0 = 1/l; k = n~/n0, the excess of density in the zone.
//   (9)  u_+ = -a x + b, a = (u0 - u_crit)/2L, b = (u0 + u_crit)/2        (10) n_+ = n0 (1 + k/2 + k x/2L)
//   (12) energy balance (11): L = m u0^2/[2 E_loss n0 (k^2/6 + k + 1)]
//   (13) slowing down of one particle: L = m u0^2/[2 E_loss n0 (2 + k)]
// so that k^2/6 + k + 1 = 2 + k, k = sqrt 6. Left-movers are the mirror image.
// A particle that runs into a much heavier cluster (reduced mass m) at speed v leaves it on the other side with
// sqrt(v^2 - v_c^2), v_c = sqrt(2 E_loss/m), or sticks, and hands over the momentum it loses; the printed form lacks
// the factor m. u_crit of (9) is that of two single particles, sqrt 2 v_c: no particle of the zone is slow enough to
// stick to a cluster, and 2 E_loss/(m u^2) <= 1/2 in (15). That needs u_crit <= u0, E_loss <= m u0^2/4. The velocity of
// the cluster itself is left out, as in the paper. T is a Real.
#pragma once

#include "cradle/core/theory/wet_shock.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace cradle::theory {

/// m u0^2/(2 E_loss n0): a length with so many particles that collisions with them cost m u0^2/2.
template <class T> T stopping_length(const WetShock<T>& shock) {
  return T(shock.mass * shock.speed * shock.speed * shock.spacing / (T(2) * shock.loss));
}
/// L from the balance of energy, equation (12).
template <class T> T half_width_from_energy(const WetShock<T>& shock, const T& k) {
  return T(stopping_length(shock) / (k * k / T(6) + k + T(1)));
}
/// L from the slowing down of one particle, equation (13).
template <class T> T half_width_from_slowing(const WetShock<T>& shock, const T& k) {
  return T(stopping_length(shock) / (T(2) + k));
}
/// k = n~/n0 = sqrt 6, where (12) and (13) agree.
template <class T> T density_excess() { return square_root(T(6)); }
/// Collisions of a particle in the zone, j* = m u0^2/E_loss.
template <class T> T collisions_to_rest(const WetShock<T>& shock) {
  return T(shock.mass * shock.speed * shock.speed / shock.loss);
}
/// Speed lost per collision of two rows closing at u0 >= u_crit: (u0/2)(1 - sqrt(1 - 4 E_loss/(m u0^2))), about
/// E_loss/(m u0) (printed before (13): E_loss/(m u0^2)).
template <class T> T zone_speed_lost(const WetShock<T>& shock) {
  return speed_lost(shock.specific_loss(), shock.speed, shock.critical_speed());
}

/// Profiles and force; throws std::domain_error unless 0 < E_loss <= m u0^2/4.
template <class T> class WetZone {
 public:
  explicit WetZone(const WetShock<T>& shock)
      : shock_(shock), excess_(density_excess<T>()), slow_(shock.critical_speed()) {
    if (!(shock.loss > T(0)) || slow_ > shock.speed)
      throw std::domain_error("the linear zone needs a loss above 0 and up to m u0^2/4");
    half_width_ = half_width_from_slowing(shock, excess_);
    piston_critical_ = square_root(T(T(2) * shock.specific_loss()));
  }

  const WetShock<T>& shock() const { return shock_; }
  const T& excess() const { return excess_; }          ///< k
  const T& half_width() const { return half_width_; }  ///< L
  T width() const { return T(T(2) * half_width_); }    ///< 2L, equation (13)
  const T& critical_speed() const { return slow_; }    ///< u_crit = sqrt(2 E_loss/mu) = 2 sqrt(E_loss/m)

  /// u_+, equation (9), for |x| <= L.
  T right_mover_velocity(const T& x) const {
    return T((shock_.speed + slow_) / T(2) - (shock_.speed - slow_) * x / width());
  }
  /// n_+ (number per length), equation (10).
  T right_mover_density(const T& x) const {
    return T((T(1) + excess_ / T(2) + excess_ * x / width()) / shock_.spacing);
  }

  /// Momentum that a particle of speed v >= 0 hands to a heavy cluster at rest: m (v - sqrt(v^2 - v_c^2)), all of it
  /// where it sticks.
  T piston_momentum(const T& v) const {
    if (!(v > piston_critical_)) return T(shock_.mass * v);
    return speed_lost(shock_.loss, v, piston_critical_);
  }

  /// F_+ on a cluster at x, equation (15): 0 at and beyond L, that of the untouched row at and beyond -L.
  T right_mover_force(const T& x) const {
    if (!(x < half_width_)) return T(0);
    if (!(x > -half_width_)) return row_force();
    return inner_right_mover_force(x);
  }
  /// F_+ + F_-, equation (14): towards the centre outside the zone, away from it inside.
  T force(const T& x) const { return force(x, row_force()); }
  /// The same with the outer force as printed, n0 E_loss (2 E_loss/(m u0^2) << 1), which is not continuous with F_+.
  T force_printed(const T& x) const { return force(x, row_force_printed()); }

  /// Force of one row outside the zone: n0 m u0^2 (1 - sqrt(1 - 2 E_loss/(m u0^2))).
  T row_force() const { return T(shock_.speed * piston_momentum(shock_.speed) / shock_.spacing); }
  T row_force_printed() const { return T(shock_.loss / shock_.spacing); }

  /// The force in the zone. With f = u dp = 2 E_loss/(1 + q), q = sqrt(1 - v_c^2/u^2), the difference n_+ f_+ - n_- f_-
  /// is taken apart into (n_+ - n_-) (f_+ + f_-)/2 + (n_+ + n_-) (f_+ - f_-)/2: both have the sign of x, nothing
  /// cancels. It continues smoothly a little beyond the edges, for integrators, until the slower row reaches v_c.
  T inner_force(const T& x) const {
    const T plus = right_mover_velocity(x);
    const T minus = right_mover_velocity(T(-x));  // speed of left-movers
    if (!(plus > piston_critical_) || !(minus > piston_critical_))
      return T(inner_right_mover_force(x) - inner_right_mover_force(T(-x)));
    const T q_plus = root_ratio(plus);
    const T q_minus = root_ratio(minus);
    const T f_plus = T(2) * shock_.loss / (T(1) + q_plus);
    const T f_minus = T(2) * shock_.loss / (T(1) + q_minus);
    // q_-^2 - q_+^2 = v_c^2 (u_-^2 - u_+^2)/(u_+ u_-)^2, u_-^2 - u_+^2 = (u_- - u_+)(u_- + u_+) = 2 a x 2 b
    const T slope = (shock_.speed - slow_) / half_width_;
    const T ratio = piston_critical_ / (plus * minus);
    const T q_squares = ratio * ratio * slope * x * (shock_.speed + slow_);
    const T f_difference = f_plus * f_minus * q_squares / (T(2) * shock_.loss * (q_plus + q_minus));
    const T n_difference = excess_ * x / (half_width_ * shock_.spacing);
    const T n_sum = (T(2) + excess_) / shock_.spacing;
    return T((n_difference * (f_plus + f_minus) + n_sum * f_difference) / T(2));
  }

 private:
  T force(const T& x, const T& outside) const {
    if (!(x < half_width_)) return T(-outside);
    return x > -half_width_ ? inner_force(x) : outside;
  }
  T inner_right_mover_force(const T& x) const {
    const T u = right_mover_velocity(x);
    if (!(u > T(0))) return T(0);
    return T(u * right_mover_density(x) * piston_momentum(u));
  }
  T root_ratio(const T& u) const { return T(square_root(T((u - piston_critical_) * (u + piston_critical_))) / u); }

  WetShock<T> shock_;
  T excess_, slow_, half_width_{0}, piston_critical_{0};
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

/// Exponents of time of amplitude, frequency, speed and energy in equation (17), M x'' = -alpha sgn x with M = m (1 + r
/// t), for r t >> 1. With g = alpha/M it is x'' = -g(t) sgn x, a Hamiltonian v^2/2 + g |x| that changes slowly, so the
/// area of the orbit, proportional to u x = sqrt(2 g x) x at amplitude x, is an adiabatic invariant: x ~ g^(-1/3) ~
/// t^(1/3), omega ~ sqrt(g/x) ~ t^(-2/3), u ~ sqrt(g x) ~ t^(-1/3), M u^2 ~ t^(1/3). If the mass were taken up at rest,
/// d(M x')/dt = -alpha sgn x, the invariant would be M u x and the oscillations would die out, x ~ t^(-1/3): the
/// paper's exponents are those of M x''.
struct OscillationExponents {
  double amplitude = 1. / 3, frequency = -2. / 3, speed = -1. / 3, energy = 1. / 3;
};

}  // namespace cradle::theory
