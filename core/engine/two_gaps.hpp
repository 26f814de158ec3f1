#pragma once
// A closed form with error bounds decides whether two neighbouring gaps collapse, and when: README.md (The theorem) has
// it, and the symbols of this file.

#include <cmath>
#include <optional>

#include "cradle/core/base/real.hpp"
#include "cradle/core/engine/gap_errors.hpp"

namespace cradle {

// Two gaps just after a collision at one of them, gap 1, "here".
template <Real T> struct TwoGaps {
  T opening;                      // r_1 w_0, w_0 the closing speed of the last collision
  T gap, closing;                 // g and w_1 of gap 2, "there"
  T rebound_here, rebound_there;  // r_1, r_2
  T handed_there, handed_here;    // c_1: added there by a collision here, c_2: added here by one there
  T of_rebound, of_handed;        // relative errors of these
};

// A number with a bound of its error.
template <Real T> struct Bounded { T value{0}, error{0}; };
template <Real T> struct CollapseAhead {
  Bounded<T> time;   // from now to t_c
  Bounded<T> ratio;  // limit of the ratio of successive intervals between collisions at the same gap
};

// Nothing if the two separate, or if rounding leaves that open. The given errors are those of the gaps here (which is
// 0) and there, now.
template <Real T>
std::optional<CollapseAhead<T>> collapse_ahead(const TwoGaps<T>& two, const GapError<T>& of_here,
                                               const GapError<T>& of_there) {
  using std::sqrt;
  const T &e = two.rebound_here, &f = two.rebound_there, unit = Roundoff<T>().unit, quotient = Roundoff<T>().quotient;
  if (!is_positive(e) || !is_positive(f) || !is_positive(two.gap) || !is_positive(two.closing)) return {};
  // Sums of positive numbers have at most the relative errors of their terms and one unit more each. The root of a
  // product has half of the errors of its factors and of the product, and one unit of its own.
  const T coupling = two.handed_there * two.handed_here, mean = sqrt(T(e * f)), least = e + f + mean + mean;
  const T excess = coupling - least;
  const T of_excess = coupling * (T(2) * two.of_handed + unit) + least * (two.of_rebound + T(4) * unit) + unit * excess;
  if (!(excess > of_excess + of_excess)) return {};
  // If x has a relative error d up to 1/2, its root has at most 3 d/5: 1 - sqrt(1 - d) <= (2 - sqrt 2) d.
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
  // The line of gap 2 plus k times that of gap 1, which is 0 now, is 0 at t_c.
  const T time = two.gap / speed, of_gaps = of_there.gap + share * of_here.gap, ratio = e * f / (larger * larger);
  const T of_time = (of_gaps + time * of_speed) / (speed - of_speed) + quotient * time;
  if (!is_finite(of_time)) return {};
  return {{{time, of_time},
           {ratio, T(ratio * (T(4) * of_larger / larger + T(2) * two.of_rebound + T(2) * unit + quotient))}}};
}

}  // namespace cradle
