#pragma once
// Whether two gaps side by side collapse, and when, in closed form, with bounds on the errors (README.md, "Collapse").
//
// A collision turns the closing speed w of its gap into -e w and adds c w to that of the other one. With u the speed at
// which the gap of the last collision opens, g the other gap and w its closing speed, and with
//
//   A = c c',  S = A - e - e',  L = (S + sqrt(S^2 - 4 e e'))/2,  k = c/(L + e)     (dashes: of the other gap)
//
// the two collapse if and only if S >= 2 sqrt(e e') and w > k u. Then t_c = t + g/(w - k u), and the intervals between
// collisions at the same gap shrink by e e'/L^2 in the end.

#include <cmath>
#include <limits>
#include <optional>

#include "cradle/core/engine/gap_errors.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

// Two gaps just after a collision at one of them, "here".
template <Real T> struct TwoGaps {
  T opening;                      // u, here
  T gap, closing;                 // g and w of the other one, there
  T rebound_here, rebound_there;  // e, e'
  T handed_there, handed_here;    // c: to there by a collision here, c': to here by one there
  T of_rebound, of_handed;        // relative errors of these
};

// A number, and what its error does not exceed.
template <Real T> struct Bounded { T value{0}, error{0}; };
template <Real T> struct CollapseAhead {
  Bounded<T> time;   // from now to t_c
  Bounded<T> ratio;  // of successive intervals between collisions at the same gap, in the end
};

// Nothing where the two part, and where rounding leaves that open. The errors given are those of the gaps here (which
// is 0) and there, now.
template <Real T>
std::optional<CollapseAhead<T>> collapse_ahead(const TwoGaps<T>& two, const GapError<T>& of_here,
                                               const GapError<T>& of_there) {
  using std::sqrt;
  const T &e = two.rebound_here, &f = two.rebound_there, unit = Roundoff<T>().unit, quotient = Roundoff<T>().quotient;
  if (!is_positive(e) || !is_positive(f) || !is_positive(two.gap) || !is_positive(two.closing)) return {};
  // Sums of positive numbers, whose relative errors are at most those of the terms and one unit more each. The root of
  // a product has half of what its factors have, that of the product, and one of its own.
  const T coupling = two.handed_there * two.handed_here, mean = sqrt(T(e * f)), least = e + f + mean + mean;
  const T excess = coupling - least;
  const T of_excess = coupling * (T(2) * two.of_handed + unit) + least * (two.of_rebound + T(4) * unit) + unit * excess;
  if (!(excess > of_excess + of_excess)) return {};
  // Where x is known to a half, its root is to 3/5 of the relative error of x: 1 - sqrt(1 - d) <= (2 - sqrt 2) d.
  const T sum = excess + T(4) * mean, of_sum = of_excess + T(4) * mean * (two.of_rebound + T(3) * unit);
  const T root = sqrt(T(excess * sum)),
          of_root = root * (T(3) * (of_excess / excess + of_sum / sum) / T(5) + T(2) * unit);
  const T larger = (excess + mean + mean + root) / T(2),
          of_larger = (of_excess + of_root) / T(2) + mean * (two.of_rebound + T(2) * unit) + T(2) * unit * larger;

  const T share = two.handed_there / (larger + e),
          of_share = share * ((of_larger + e * two.of_rebound) / (larger + e) + two.of_handed + unit + quotient);
  const T speed = two.closing - share * two.opening;
  const T of_speed = of_there.speed + share * of_here.speed + two.opening * (of_share + unit * share) + unit * speed;
  if (!(speed > of_speed + of_speed)) return {};
  // The line of g + k times the line here, which is 0 now, is 0 at t_c.
  const T time = two.gap / speed, of_gaps = of_there.gap + share * of_here.gap, ratio = e * f / (larger * larger);
  const T of_time = (of_gaps + time * of_speed) / (speed - of_speed) + quotient * time;
  if (!is_finite(of_time)) return {};
  return {{{time, of_time},
           {ratio, T(ratio * (T(4) * of_larger / larger + T(2) * two.of_rebound + T(2) * unit + quotient))}}};
}

}  // namespace cradle
