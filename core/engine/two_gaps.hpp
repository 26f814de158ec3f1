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

#include "cradle/core/real.hpp"

namespace cradle {

// Two gaps just after a collision at one of them, "here".
template <Real T> struct TwoGaps {
  T opening;                      // u, here
  T gap, closing;                 // g and w of the other one, there
  T rebound_here, rebound_there;  // e, e'
  T handed_there, handed_here;    // c: to there by a collision here, c': to here by one there
  int roundings;                  // that these two have in them at most
};

// A number, and what its error does not exceed.
template <Real T> struct Bounded { T value{0}, error{0}; };
template <Real T> struct CollapseAhead {
  Bounded<T> time;   // from now to t_c
  Bounded<T> ratio;  // of successive intervals between collisions at the same gap, in the end
};

// Nothing where the two part, and where rounding leaves that open. The errors given are those of speeds and of gaps.
template <Real T>
std::optional<CollapseAhead<T>> collapse_ahead(const TwoGaps<T>& two, const T& of_speeds, const T& of_gaps) {
  using std::sqrt;
  const T &e = two.rebound_here, &f = two.rebound_there, unit = T(std::numeric_limits<T>::epsilon()) / T(2);
  if (!is_positive(e) || !is_positive(f) || !is_positive(two.gap) || !is_positive(two.closing)) return {};
  // Sums of positive numbers: of restitutions that may be rounded decimals, three additions and a root.
  const T coupling = two.handed_there * two.handed_here, mean = sqrt(T(e * f));
  const T least = e + f + mean + mean, of_sum = unit * (T(2 * two.roundings + 1) * coupling + T(5) * least);
  const T excess = coupling - least;
  if (!(excess > of_sum + of_sum)) return {};
  const T root = sqrt(T(excess * (excess + T(4) * mean)));
  const T of_root = root * (of_sum / excess + of_sum / (excess + T(4) * mean));
  const T larger = (excess + mean + mean + root) / T(2), of_larger = (of_sum + of_root) / T(2) + T(2) * unit * larger;

  const T share = two.handed_there / (larger + e),
          of_share = share * (of_larger / (larger + e) + T(two.roundings + 4) * unit);
  const T speed = two.closing - share * two.opening;
  const T of_speed = of_speeds * (T(1) + share) + two.opening * of_share + unit * (two.closing + two.opening);
  if (!(speed > of_speed + of_speed)) return {};
  const T time = two.gap / speed, ratio = e * f / (larger * larger);
  return {{{time, T((of_gaps + time * of_speed) / (speed - of_speed) + T(4) * unit * time)},
           {ratio, T(T(4) * ratio * (of_larger / larger + unit))}}};
}

}  // namespace cradle
