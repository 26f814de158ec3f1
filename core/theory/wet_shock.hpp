// The front of the wet shock: two rows of equal particles, spacing l, running into each other at +u0 (left) and -u0
// (right), each collision taking the energy E_loss. "Dry and wet granular shock waves", section V.
// Wet particles pass through each other, so the very first particle of the left row is a tracer that meets one fresh
// particle of the right row after the other. With e = E_loss/m and r = u + u0, its closing speed at the next collision,
//     r_{n+1} = r_n/2 + sqrt(r_n^2/4 - e),   that is   r_n = r_{n+1} + e/r_{n+1},   r_0 = 2 u0,
//     t_{n+1} = t_n + l/r_n,   x_n = x_0 + n l - u0 t_n,   x_0 = -l/2 ,
// until r_n <= 2 sqrt e, where it sticks. This discrete form is exact. The continuous one, equation (8) integrated with
// y = r/(2 sqrt e) + sqrt(r^2/(4e) - 1), that is r = sqrt e (y + 1/y), and y = y0 at u = u0, is
//     n = (y0^2 - y^2)/2 - ln(y0/y),   t = (l/sqrt e) [(y0 - y) - 2 (atan y0 - atan y)],   x = x_0 + n l - u0 t ,
// from y0 down to y = 1, where the tracer sticks. It is evaluated in d = y0 - y and s = y - 1, all terms positive, so
// that nothing cancels at small times, small losses or near the threshold.
// Units: lengths, times and masses of the scene. T is a Real with log and atan by ADL.
#pragma once

#include "cradle/core/base/real.hpp"
#include "cradle/core/theory/inelastic_shock.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

namespace cradle::theory {

/// Largest closing speed at which two particles of reduced mass mu stick, sqrt(2 E_loss/mu), of equal ones 2 sqrt e.
template <class T> T critical_closing_speed(const T& loss, const T& mass_left, const T& mass_right) {
  return square_root(T(T(2) * loss * ((mass_left + mass_right) / (mass_left * mass_right))));
}

/// The same as the paper's section II prints it, sqrt(2 E_loss)/mu, for comparison only: right if mu = 1.
template <class T> T critical_closing_speed_printed(const T& loss, const T& mass_left, const T& mass_right) {
  return T(square_root(T(T(2) * loss)) * ((mass_left + mass_right) / (mass_left * mass_right)));
}

/// Parameters, loss >= 0, the rest positive; defaults are the paper's units.
template <class T> struct WetShock {
  T loss;                       ///< E_loss
  T speed = T(T(1) / T(2));     ///< u0
  T spacing = T(1);             ///< l
  T mass = T(1);                ///< m, of one particle
  std::uint64_t particles = 0;  ///< N, both rows together; enters only the energy

  T specific_loss() const { return T(loss / mass); }
  /// 2 sqrt e: two single particles that close no faster stick.
  T critical_speed() const { return critical_closing_speed(loss, mass, mass); }
  /// x_0 = -l/2, where the tracer starts.
  T origin() const { return T(-spacing / T(2)); }
};

/// The speed that each of two single particles loses at the closing speed w > w_c, (w - w')/2 = 2e/(w + w'), w' =
/// sqrt(w^2 - w_c^2). With E_loss for e it is the impulse, of any masses.
template <class T> T speed_lost(const T& specific_loss, const T& w, const T& critical) {
  return T(T(2) * specific_loss / (w + square_root(T((w - critical) * (w + critical)))));
}

// ---- discrete: the tracer, exact ----

/// The tracer from collision to collision. Sums are compensated: t_n and u_n carry a few roundings, not n.
template <class T> class WetFrontRecursion {
 public:
  explicit WetFrontRecursion(const WetShock<T>& shock)
      : shock_(shock), loss_(shock.specific_loss()),
        critical_(shock.critical_speed()), now_{0, T(0), shock.origin(), shock.speed} {}

  const FrontCollision<T>& now() const { return now_; }
  /// Time of the next collision.
  T next_time() const { return T(now_.time + shock_.spacing / closing_speed()); }
  /// Whether the tracer will stick at the next collision.
  bool sticks_next() const { return !(closing_speed() > critical_); }

  /// Advances to the next collision; if the tracer sticks at it, returns false and changes nothing.
  bool advance() {
    if (sticks_next()) return false;
    const T w = closing_speed();
    time_.add(T(shock_.spacing / w));
    lost_.add(speed_lost(loss_, w, critical_));
    ++now_.collision;
    now_.time = time_.value();
    now_.velocity = T(shock_.speed - lost_.value());
    now_.position =
        T(shock_.origin() + (shock_.spacing * T(static_cast<std::int64_t>(now_.collision)) - shock_.speed * now_.time));
    return true;
  }

  /// Advances to the last collision at or before `t`.
  void advance_to(const T& t) {
    while (!(next_time() > t) && advance()) {
    }
  }

  /// Position at time t, from the collision before it up to the next one; none once the tracer has stuck.
  std::optional<T> position_at(const T& t) const {
    if (sticks_next() && t > next_time()) return std::nullopt;
    return T(now_.position + now_.velocity * (t - now_.time));
  }

 private:
  T closing_speed() const { return T(now_.velocity + shock_.speed); }

  WetShock<T> shock_;
  T loss_, critical_;
  CompensatedSum<T> time_, lost_;  // lost_: u0 - u_n
  FrontCollision<T> now_;
};

/// The tracer just after its last collision at or before time t >= 0, in as many steps as it has had collisions.
template <class T> WetFrontRecursion<T> front_recursion_at(const WetShock<T>& shock, const T& t) {
  WetFrontRecursion<T> recursion(shock);
  recursion.advance_to(t);
  return recursion;
}

/// The collision at which the tracer is farthest, the first with u_n <= 0; its reach is position - origin(). None where
/// it sticks before, or never slows (loss 0). Takes about 3 u0^2/(2 e) steps; throws std::overflow_error above `most`.
template <class T>
std::optional<FrontCollision<T>> turnover_collision(const WetShock<T>& shock, std::uint64_t most = 100'000'000) {
  if (!(shock.loss > T(0))) return std::nullopt;
  WetFrontRecursion<T> recursion(shock);
  while (recursion.now().velocity > T(0)) {
    if (recursion.now().collision == most)
      throw std::overflow_error("the front turns after too many collisions: use the continuous form");
    if (!recursion.advance()) return std::nullopt;
  }
  return recursion.now();
}

// ---- continuous: equation (8) in closed form ----

/// The front with the number of collisions n as a real number.
template <class T> struct WetFrontState { T collisions, time, position, velocity; };

namespace detail {

/// z - atan z for z >= 0, to full relative precision also for small z.
template <class T> T arctangent_deficit(const T& z) {
  using std::atan;
  if (!(T(2) * z < T(1))) return T(z - atan(z));
  const T square = z * z;
  T power = z * square;
  T sum(0);
  for (int k = 3;; k += 4) {  // pairs of terms of the alternating series: all sums positive
    const T next = sum + power * (T(1) / T(k) - square / T(k + 2));
    if (next == sum) return sum;
    sum = next;
    power = T(power * square * square);
  }
}

}  // namespace detail

/// Equation (8): the trajectory of the front as a function of its velocity or of time.
template <class T> class WetFront {
 public:
  explicit WetFront(const WetShock<T>& shock) : shock_(shock) {
    root_ = square_root(shock.specific_loss());
    if (!moves() || !(root_ > T(0))) return;
    excess0_ = excess(shock.speed);
    depth0_ = from_excess(excess0_);
    y0_ = T(T(1) + depth0_);
  }

  /// The front at velocity u <= u0; none if it sticks before it is that slow, or never slows (loss 0).
  std::optional<WetFrontState<T>> at_velocity(const T& u) const {
    if (!moves() || u > shock_.speed) return std::nullopt;
    if (!(root_ > T(0)) && u < shock_.speed) return std::nullopt;
    if (!(u < shock_.speed)) return WetFrontState<T>{T(0), T(0), shock_.origin(), shock_.speed};
    const T h = excess(u);
    if (h < T(0)) return std::nullopt;
    // y0 - y = (h0 - h) + [sqrt(h0 (h0+2)) - sqrt(h (h+2))], the bracket as a quotient
    const T step = (shock_.speed - u) / (T(2) * root_);
    const T roots = square_root(T(excess0_ * (excess0_ + T(2)))) + square_root(T(h * (h + T(2))));
    auto found = state(T(step + step * (excess0_ + h + T(2)) / roots), from_excess(h));
    found.velocity = u;
    return found;
  }

  /// At time t >= 0; none after it has stuck.
  std::optional<WetFrontState<T>> at_time(const T& t) const {
    if (!moves()) return std::nullopt;
    if (!(root_ > T(0))) {
      const T free = shock_.speed * t;
      return WetFrontState<T>{T(T(2) * free / shock_.spacing), t, T(shock_.origin() + free), shock_.speed};
    }
    if (t > time_of(depth0_, T(0))) return std::nullopt;
    // t(d) rises ever more slowly, so that Newton's steps from 0 approach from below and never pass the root
    T d(0);
    while (true) {
      const T s = depth0_ - d;
      const T y = y0_ - d;
      const T slope = s * (y + T(1)) / (y * y + T(1));
      const T missing = t * root_ / shock_.spacing - scaled_time(d, s);
      if (!(missing > T(0)) || !(slope > T(0))) break;
      const T next = d + missing / slope;
      if (!(next > d)) break;
      if (!(next < depth0_)) {
        d = depth0_;
        break;
      }
      d = next;
    }
    auto found = state(d, T(depth0_ - d));
    found.time = t;
    return found;
  }

  /// The front at u = 0: n*, t*, x*. None if it sticks before (u0 < 2 sqrt e).
  std::optional<WetFrontState<T>> turnover() const { return at_velocity(T(0)); }

  /// The front at u = 2 sqrt e - u0, where it sticks; none without loss.
  std::optional<WetFrontState<T>> sticking() const {
    if (!moves() || !(root_ > T(0))) return std::nullopt;
    return state(depth0_, T(0));
  }

 private:
  // Rows that close at no more than 2 sqrt e stick at the first collision.
  bool moves() const { return shock_.speed > root_; }

  // h = r/(2 sqrt e) - 1 and s = y - 1 = h + sqrt(h (h+2))
  T excess(const T& u) const { return T((u + shock_.speed - T(2) * root_) / (T(2) * root_)); }
  static T from_excess(const T& h) { return T(h + square_root(T(h * (h + T(2))))); }

  // t sqrt(e)/l with z = tan(atan y0 - atan y): d = z (1 + y0 y), and y0 y - 1 = s0 + y0 s
  T scaled_time(const T& d, const T& s) const {
    const T y = T(1) + s;
    const T z = d / (T(1) + y0_ * y);
    return T(z * (depth0_ + y0_ * s) + T(2) * detail::arctangent_deficit(z));
  }
  T time_of(const T& d, const T& s) const { return T(shock_.spacing / root_ * scaled_time(d, s)); }

  WetFrontState<T> state(const T& d, const T& s) const {
    const T y = T(1) + s;
    const T product = depth0_ + y0_ * s;  // y0 y - 1
    const T ratio = d / y;
    const T collisions = ratio * ((product + s * (y + T(1))) / T(2) + detail::log_deficit(ratio));
    const T time = time_of(d, s);
    return {collisions, time, T(shock_.origin() + (collisions * shock_.spacing - shock_.speed * time)),
            T(shock_.speed - root_ * d * product / (y0_ * y))};
  }

  WetShock<T> shock_;
  T root_{0};     // sqrt e
  T excess0_{0};  // h at u0
  T depth0_{0};   // y0 - 1
  T y0_{1};
};

}  // namespace cradle::theory
