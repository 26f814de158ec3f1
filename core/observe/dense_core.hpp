#pragma once
// The core that a shock of dissipative particles leaves at its centre: its mass, its width, the range of its
// velocities, its gaps. Definitions, for all particles that have collided:
//
//   width   is the length of the shortest interval that holds more than half of their mass (a robust measure: incoming
//           particles do not count until they are half of all); 0 if that is one particle, merged from many;
//   mass    is the mass within three such lengths around the same middle: the core. With m = 1 it is the number of its
//           particles;
//   range   is the range of the velocities of the core, from the 5 % to the 95 % quantile by mass;
//   gap     is the median of the gaps within the core; NaN if it is one particle.
//
// Positions decide which interval is the shortest; if they do not resolve it, that is unknown. Its width is a sum of
// gaps. Units of the scene; float64. All NaN if there are fewer than two particles.

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/observe/configuration_statistics.hpp"

namespace cradle {

struct DenseCore {
  double mass, width, velocity_range, gap;
};

namespace detail {

struct Interval {  // particles first to last, both included
  std::size_t first, last;
};

// The shortest interval with more than half of the mass; ties go left to right.
template <Real T> Interval shortest_half(const Configuration<T>& c) {
  double all = 0, held = 0;
  for (std::size_t j = c.collided_from; j < c.collided_to; ++j) all += to_double(c.m[j]);
  const double half = all / 2 * (1 + 0x1p-40);  // sums are rounded
  Interval best{c.collided_from, c.collided_to - 1};
  T shortest = c.x[best.last] - c.x[best.first];
  std::size_t first = c.collided_from;
  for (std::size_t last = first; last < c.collided_to; ++last) {
    held += to_double(c.m[last]);
    for (; held > half; held -= to_double(c.m[first++]))
      if (const T length = c.x[last] - c.x[first]; length < shortest) shortest = length, best = {first, last};
  }
  return best;
}

}  // namespace detail

// For a configuration on a line.
template <Real T> DenseCore dense_core(const Configuration<T>& c) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (c.collided_to < c.collided_from + 2) return {none, none, none, none};
  const detail::Interval half = detail::shortest_half(c);
  T width(0);  // from the gaps, which resolve what positions cannot
  for (std::size_t j = half.first; j < half.last; ++j) width += c.gap[j];
  const T from = c.x[half.first] - width, to = c.x[half.last] + width;
  std::vector<std::pair<double, double>> velocities;  // and masses
  std::vector<double> gaps;
  double mass = 0;
  for (std::size_t j = c.collided_from; j < c.collided_to; ++j) {
    if (c.x[j] < from || to < c.x[j]) continue;
    if (!velocities.empty()) gaps.push_back(to_double(c.gap[j - 1]));
    velocities.emplace_back(to_double(c.v[j]), to_double(c.m[j]));
    mass += velocities.back().second;
  }
  std::sort(velocities.begin(), velocities.end());
  const auto quantile = [&](double share) {
    double below = 0;
    for (const auto& [v, m] : velocities)
      if ((below += m) >= share * mass) return v;
    return velocities.back().first;
  };
  const double gap = gaps.empty() ? none : median(std::move(gaps));
  return {mass, to_double(width), quantile(0.95) - quantile(0.05), gap};
}

}  // namespace cradle
