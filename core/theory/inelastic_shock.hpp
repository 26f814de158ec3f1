// The inelastic shock: two rows of equal particles, spacing l, running into each other at +u0 (left) and -u0 (right).
// "Dry and wet granular shock waves", section IV. Equal particles that bounce may be relabelled as passing through each
// other, so the very first particle of the left row is a tracer: after n collisions, at time t_n, it is at x_n with
// velocity u_n,
//     u_{n+1} = u_n (1+eps)/2 - u0 (1-eps)/2,   x_{n+1} = x_n + u_n dt_n,   dt_n = l/(u_n + u0),   x_0 = -l/2 .
// These discrete forms are exact (for about 2/(1-eps) collisions); equations (4) to (7) are continuous approximations.
// Units: lengths, times and masses of the scene; densities are mass per length; rho0 = m/l.
// kappa = (1-eps)/(1+eps) and s = 2 u0 t kappa/l; every form is written so that nothing cancels as eps -> 1, and eps =
// 1 (rows that pass freely) is the limit, not a special case. T is a Real with log by ADL.
#pragma once

#include "cradle/core/theory/inelastic_collapse.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

namespace cradle::theory {

/// Parameters, 0 <= restitution <= 1, the rest positive; defaults are the paper's units.
template <class T> struct InelasticShock {
  T restitution;                ///< eps
  T speed = T(T(1) / T(2));     ///< u0
  T spacing = T(1);             ///< l
  T mass = T(1);                ///< m, of one particle
  std::uint64_t particles = 0;  ///< N, both rows together; enters only the energy

  /// (1-eps)/(1+eps): what each collision adds to the ratio of two successive intervals.
  T kappa() const { return T((T(1) - restitution) / (T(1) + restitution)); }
  /// x_0 = -l/2, where the tracer starts. The paper calls x_0 the centre of the wave and sets it to 0 from (5) on.
  T origin() const { return T(-spacing / T(2)); }
  T row_density() const { return T(mass / spacing); }
};

namespace detail {

/// sum of (1+kappa)^k for k < n, by doubling, S_2k = S_k (2 + kappa S_k): all terms positive, error a few log2(n) ulp.
template <class T> T geometric_sum(const T& kappa, std::uint64_t n) {
  T sum(0);
  for (auto bit = static_cast<int>(std::bit_width(n)); bit-- > 0;) {
    sum = T(sum * (T(2) + kappa * sum));
    if (((n >> bit) & 1U) != 0) sum = T(sum + (T(1) + kappa * sum));
  }
  return sum;
}

/// 1 - ln(1+z)/z for z >= 0 to full relative precision; 0 at z = 0.
template <class T> T log_deficit(const T& z) {
  using std::log;
  if (!(z < T(1))) return T(T(1) - log(T(T(1) + z)) / z);
  const T w = z / (T(2) + z);  // ln(1+z) = 2 artanh w and 2 w/z = 1 - w
  const T square = w * w;
  T power = square;
  T sum(0);
  for (int k = 3;; k += 2) {
    const T next = sum + power / T(k);
    if (next == sum) break;
    sum = next;
    power = T(power * square);
  }
  return T(w - (T(1) - w) * sum);
}

/// Smallest n >= 1 for which `reached(n)`, false then true, is true. Throws std::overflow_error beyond 2^62.
template <class Condition> std::uint64_t first_count(Condition&& reached) {
  std::uint64_t high = 1;
  while (!reached(high)) {
    if ((high >> 62) != 0)
      throw std::overflow_error("collision count is out of range (above 2^62): use a shorter time");
    high *= 2;
  }
  std::uint64_t low = high / 2;
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (reached(middle) ? high : low) = middle;
  }
  return high;
}

/// How far the front (5) lags behind a free particle: u0 t - x_f(t), without the cancellation of the two.
template <class T> T front_lag(const InelasticShock<T>& shock, const T& t) {
  const T kappa = shock.kappa();
  const T own = log_deficit(kappa);
  const T lag = log_deficit(T(T(2) * shock.speed * t * kappa / shock.spacing)) - own;
  return T(T(2) * shock.speed * t * lag / (T(1) - own));
}

}  // namespace detail

// ---- discrete: the tracer, exact ----

/// The tracer just after collision n (n = 0: the start).
template <class T> struct FrontCollision {
  std::uint64_t collision;
  T time;      ///< t_n
  T position;  ///< x_n, from x_0 = -l/2
  T velocity;  ///< u_n, after the collision
};

/// u_n, x_n, t_n in closed form; printed correctly, with x_0 = -l/2.
template <class T> FrontCollision<T> front_collision(const InelasticShock<T>& shock, std::uint64_t n) {
  const T sum = detail::geometric_sum(shock.kappa(), n);
  const T slowed = shock.kappa() * sum;  // ((1+eps)/2)^-n = 1 + kappa sum
  const T half = shock.spacing / T(2);
  return {n, T(half * sum / shock.speed),
          T(shock.origin() + shock.spacing * T(static_cast<std::int64_t>(n)) - half * sum),
          T(shock.speed * (T(1) - slowed) / (T(1) + slowed))};
}

/// The recursion as printed, one collision per call. Rounding grows with n, unlike in `front_collision`.
template <class T> class FrontRecursion {
 public:
  explicit FrontRecursion(const InelasticShock<T>& shock) : shock_(shock), now_{0, T(0), shock.origin(), shock.speed} {}

  const FrontCollision<T>& now() const { return now_; }
  void advance() {
    const T interval = shock_.spacing / (now_.velocity + shock_.speed);
    now_.position = T(now_.position + now_.velocity * interval);
    now_.time = T(now_.time + interval);
    const T gain = T(1) + shock_.restitution;
    const T loss = T(1) - shock_.restitution;
    now_.velocity = T((now_.velocity * gain - shock_.speed * loss) / T(2));
    ++now_.collision;
  }

 private:
  InelasticShock<T> shock_;
  FrontCollision<T> now_;
};

/// The last collision at or before time t >= 0; between collisions the tracer flies on from there at its velocity.
template <class T> FrontCollision<T> front_collision_before(const InelasticShock<T>& shock, const T& t) {
  const T kappa = shock.kappa();
  const T limit = T(2) * shock.speed * t / shock.spacing;
  const auto after = detail::first_count([&](std::uint64_t n) { return detail::geometric_sum(kappa, n) > limit; });
  return front_collision(shock, after - 1);
}

/// The tracer's exact position at time t >= 0 (length, from the centre of the wave).
template <class T> T front_position_discrete(const InelasticShock<T>& shock, const T& t) {
  const auto last = front_collision_before(shock, t);
  return T(last.position + last.velocity * (t - last.time));
}

/// The collision at which the tracer is farthest, by position - origin(): the first with u_n <= 0. None at eps = 1.
template <class T> std::optional<FrontCollision<T>> turnover_collision(const InelasticShock<T>& shock) {
  const T kappa = shock.kappa();
  if (!(kappa > T(0))) return std::nullopt;
  const auto n =
      detail::first_count([&](std::uint64_t k) { return !(kappa * detail::geometric_sum(kappa, k) < T(1)); });
  return front_collision(shock, n);
}

// ---- continuous: equations (4) and (5) ----

/// Front velocity, equation (4). Not exactly the derivative of (5): they differ by O(1-eps).
template <class T> T front_velocity(const InelasticShock<T>& shock, const T& t) {
  const T s = T(2) * shock.speed * t * shock.kappa() / shock.spacing;
  return T(shock.speed * (T(1) - s) / (T(1) + s));
}

/// Distance the tracer has come from its start, x_f - x_0: equation (5) as printed, where x_0 is set to 0.
template <class T> T front_displacement(const InelasticShock<T>& shock, const T& t) {
  return T(shock.speed * t - detail::front_lag(shock, t));
}

/// Position of the right front from the centre of the wave, equation (5) with x_0 = -l/2; the left front is its mirror.
template <class T> T front_position(const InelasticShock<T>& shock, const T& t) {
  return T(shock.origin() + front_displacement(shock, t));
}

/// t* at which (4) vanishes, l (1+eps)/(2 u0 (1-eps)). None at eps = 1.
template <class T> std::optional<T> turnover_time(const InelasticShock<T>& shock) {
  if (!(shock.restitution < T(1))) return std::nullopt;
  return T(shock.spacing / (T(2) * shock.speed * shock.kappa()));
}

/// x_max, the displacement (5) at t*; does not depend on u0. None at eps = 1.
template <class T> std::optional<T> maximal_front(const InelasticShock<T>& shock) {
  using std::log;
  if (!(shock.restitution < T(1))) return std::nullopt;
  const T kappa = shock.kappa();
  const T count = log(T(2)) / (T(1) - detail::log_deficit(kappa)) - T(1) / T(2);
  return T(shock.spacing * count / kappa);
}

// ---- linear profiles in |x| <= x_f, (6) and (7); x_f is the displacement, t > 0 and before the turnover ----

/// Density in the interaction zone (mass per length), rho0 (1 + u0 t/x_f).
template <class T> T interaction_density(const InelasticShock<T>& shock, const T& t) {
  return T(shock.row_density() * (T(1) + shock.speed * t / front_displacement(shock, t)));
}

/// rho_+, the density (mass per length) of particles that came from the left; its integral is rho0 (x_f + u0 t).
template <class T> T right_mover_density(const InelasticShock<T>& shock, const T& x, const T& t) {
  const T front = front_displacement(shock, t);
  const T excess = (front + x) * detail::front_lag(shock, t) / (T(2) * front * front);
  return T(shock.row_density() * (T(1) + excess));
}
/// rho_-, of particles that came from the right.
template <class T> T left_mover_density(const InelasticShock<T>& shock, const T& x, const T& t) {
  return right_mover_density(shock, T(-x), t);
}

/// u_+ (length/time).
template <class T> T right_mover_velocity(const InelasticShock<T>& shock, const T& x, const T& t) {
  const T depth = front_displacement(shock, t) + x;
  return T(shock.speed * (T(1) - (T(1) - shock.restitution) * depth / shock.spacing));
}
/// u_-, with its sign: the printed form is the speed, -u_-.
template <class T> T left_mover_velocity(const InelasticShock<T>& shock, const T& x, const T& t) {
  return T(-right_mover_velocity(shock, T(-x), t));
}

/// Slope of the mean velocity (1/time), equation (6), first line, which as printed lacks the factor u0.
/// It is (rho_+ u_+ + rho_- u_-)/rho_int exactly; meant for l << u0 t, since it grows like -l/t before.
template <class T> T mean_velocity_slope(const InelasticShock<T>& shock, const T& t) {
  const T front = front_displacement(shock, t);
  const T free = shock.speed * t;
  const T slowing = T(2) * free * front * (T(1) - shock.restitution) / shock.spacing;
  return T(shock.speed * (detail::front_lag(shock, t) - slowing) / ((front + free) * front));
}

/// Mean velocity at x (length/time), equation (6), first line with the factor u0.
template <class T> T mean_velocity(const InelasticShock<T>& shock, const T& x, const T& t) {
  return T(mean_velocity_slope(shock, t) * x);
}

/// Equation (6), second line: u0 ln[(1+eps)/2]/l (1/time), the limit of the first for l << u0 t << l/(1-eps).
template <class T> T mean_velocity_slope_early(const InelasticShock<T>& shock) {
  const T kappa = shock.kappa();
  return T(-shock.speed * kappa * (T(1) - detail::log_deficit(kappa)) / shock.spacing);
}

/// N m u0^2/2, of an inelastic or a wet shock.
template <template <class> class Shock, class T> T initial_energy(const Shock<T>& shock) {
  return T(T(static_cast<std::int64_t>(shock.particles)) * shock.mass * shock.speed * shock.speed / T(2));
}

/// Energy, equation (7) with + before 2/3 (printed: -, which would gain energy, the bracket being negative).
/// It is that of the linear profiles; the loss is 1.7, 5.4, 15 % too small at t*/4, t*/2, t* (eps = 0.999, N-particle).
template <class T> T energy(const InelasticShock<T>& shock, const T& t) {
  const T front = front_displacement(shock, t);
  const T free = shock.speed * t;
  const T depth = (T(1) - shock.restitution) * front / shock.spacing;
  const T bracket = depth * (T(3) * free + front) - T(2) * (T(2) * free + front);
  const T scale = T(2) * shock.row_density() * shock.speed * shock.speed / T(3);
  return T(initial_energy(shock) + scale * depth * bracket);
}

/// Energy of the sticky gas from the same start, E(0) - m u0^3 t/l; 0 once the rows are used up, at t = N l/(2 u0).
template <class T> T sticky_energy(const InelasticShock<T>& shock, const T& t) {
  const T left = initial_energy(shock) - shock.row_density() * shock.speed * shock.speed * shock.speed * t;
  return left > T(0) ? left : T(0);
}

/// When the particles engaged, 2 u0 t/l, reach `collapse_onset_particles`: N_c l/(2 u0). None at eps = 1.
template <class T> std::optional<T> collapse_onset_time(const InelasticShock<T>& shock) {
  const auto particles = collapse_onset_particles(shock.restitution);
  if (!particles) return std::nullopt;
  return T(*particles * shock.spacing / (T(2) * shock.speed));
}

}  // namespace cradle::theory
