#pragma once
// Numbers computed from a configuration: sums that check the run's ledger, and the statistics of its gaps.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/configuration.hpp"

namespace cradle {

// Mass and momentum at the start of the particles that are not in a configuration.
template <Real T> struct OfOthers {
  T mass, momentum;
  OfOthers(const Configuration<T>& c, const Particles<T>& particles)
      : mass(particles.mass_between(0, c.from) + particles.mass_between(c.to + 1, particles.count())),
        momentum(particles.momentum()) {
    CompensatedSum<T> held;
    for (ParticleIndex b = c.from; b <= c.to; ++b) held.add(particles.mass(b) * particles.velocity(b));
    momentum -= held.value();
  }
};

// Kinetic energy summed over all particles of the scene at a time since the start, which matters only where they fall:
// the direct sum that is compared with the ledger.
template <Real T> T kinetic_energy(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed = T(0)) {
  // Of the particles in the configuration, now and at the start; and what the others have gained.
  CompensatedSum<T> twice, twice_before, gained;
  for (std::size_t j = 0; j < c.x.size(); ++j) twice.add(c.m[j] * c.v[j] * c.v[j]);
  for (ParticleIndex b = c.from; b <= c.to; ++b)
    twice_before.add(particles.mass(b) * particles.velocity(b) * particles.velocity(b));
  if (particles.fall()) {
    const OfOthers<T> others(c, particles);
    const T speed = Fall<T>(particles, elapsed).speed;
    gained.add(T(2) * others.momentum * speed);
    gained.add(others.mass * speed * speed);
  }
  return particles.kinetic_energy() + (twice.value() - twice_before.value() + gained.value()) / T(2);
}

// Potential energy of all particles of the scene under gravity, -a sum m x, at a time since the start.
template <Real T> T potential_energy(const Configuration<T>& c, const Particles<T>& particles, const T& elapsed) {
  const T a = particles.acceleration();
  CompensatedSum<T> moment, moment_before;  // of the particles in the configuration
  for (std::size_t j = 0; j < c.x.size(); ++j) moment.add(c.m[j] * c.x[j]);
  if (c.from == 0 && c.to + 1 == particles.count()) return -(a * moment.value());
  for (ParticleIndex b = c.from; b <= c.to; ++b) moment_before.add(particles.mass(b) * particles.position(b));
  const OfOthers<T> others(c, particles);
  const T of_others = others.momentum * elapsed + others.mass * Fall<T>(particles, elapsed).way;
  return particles.potential_energy() - a * ((moment.value() - moment_before.value()) + of_others);
}

// Momentum that a configuration's particles have gained since the start; zero but for rounding, walls and gravity.
template <Real T> T momentum_gained(const Configuration<T>& c, const Particles<T>& particles) {
  CompensatedSum<T> gained;
  for (std::size_t j = 0; j < c.x.size(); ++j) gained.add(c.m[j] * c.v[j]);
  for (ParticleIndex b = c.from; b <= c.to; ++b) gained.add(-particles.mass(b) * particles.velocity(b));
  return gained.value();
}

// Of an even number the mean of the two in the middle.
template <class T> T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : T((*std::max_element(values.begin(), middle) + *middle) / T(2));
}

template <Real T> struct GapStatistics { T least{0}, median{0}; };

// Statistics of the gaps of a configuration with at least two particles.
template <Real T> GapStatistics<T> gap_statistics(const Configuration<T>& c) {
  return {*std::min_element(c.gap.begin(), c.gap.end()), median(c.gap)};
}

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
