#pragma once
// Numbers computed from a configuration: sums that check the run's ledger, and the statistics of its gaps.

#include <algorithm>
#include <cstddef>
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

}  // namespace cradle
