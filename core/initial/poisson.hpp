#pragma once
// Positions of a Poisson process: the gaps are independent and exponential, of mean one spacing, in place of a lattice.
// They are displacements from the lattice (rows.hpp), whole numbers of 2^-28 of a spacing: particles are in order, and
// every scalar type starts from the same positions. A gap is keyed by seed, replica and particle.
//
// A gap of n units has the probability (1 - q) q^(n-1), q = exp(-2^-28), n = 1, 2, ...: each unit holds a particle with
// the same probability 1 - q, whatever the others hold. This is a Poisson process, looked at with that resolution.
// Where the length is given, on a ring and between walls, N particles are at N independent, uniform places: with gaps
// e_0, ..., e_N the sums e_0 + ... + e_k, over the sum of all, are distributed like N sorted uniform numbers.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/initial/rows.hpp"

namespace cradle {

// An exponential gap of mean 1, in units of 2^-28.
inline std::int64_t exponential_gap(std::uint64_t seed, std::uint64_t replica, ParticleIndex particle) {
  // Indices that no velocity and no wall has (gas.hpp, wall.hpp).
  const std::uint64_t bits =
      random_bits(seed, replica, static_cast<std::uint64_t>(particle) | std::uint64_t{0xFD} << 56);
  return static_cast<std::int64_t>(exponential(bits) * static_cast<double>(displacement_unit)) + 1;
}

namespace detail {

using Displacements = std::shared_ptr<std::vector<std::int64_t>>;

// Throws std::invalid_argument for more particles than 64 bits hold places for.
inline Displacements displacements(ParticleIndex count) {
  require_countable(count, "a Poisson process");
  return std::make_shared<std::vector<std::int64_t>>(static_cast<std::size_t>(count));
}

inline Displacement looked_up(Displacements all) {
  return [all = std::move(all)](ParticleIndex particle) { return (*all)[static_cast<std::size_t>(particle)]; };
}

// floor(a b/c), 0 <= a < c < 2^63, 0 <= b < 2^62.
inline std::int64_t share_of(std::int64_t a, std::int64_t b, std::int64_t c) {
  __extension__ using Integer128 = __int128;
  return static_cast<std::int64_t>(Integer128{a} * b / c);
}

}  // namespace detail

// From particle `origin` on to both sides: `half_steps(p)` is the place of particle p on the lattice, in half spacings.
// `at_origin`: whether particle `origin` is at the place 0; otherwise this is between it and the particle before it.
template <class HalfSteps>
Displacement poisson_displacement(ParticleIndex count, ParticleIndex origin, bool at_origin, HalfSteps half_steps,
                                  std::uint64_t seed, std::uint64_t replica) {
  const detail::Displacements all = detail::displacements(count);
  const auto put = [&](ParticleIndex particle, std::int64_t place) {
    (*all)[static_cast<std::size_t>(particle)] = place - half_steps(particle) * (displacement_unit / 2);
  };
  std::int64_t place = 0;
  for (ParticleIndex particle = origin; particle < count; ++particle) {
    if (particle > origin || !at_origin) place += exponential_gap(seed, replica, particle);
    put(particle, place);
  }
  place = 0;
  for (ParticleIndex particle = origin; particle-- > 0;)
    put(particle, place -= exponential_gap(seed, replica, particle));
  return detail::looked_up(all);
}

// `count` independent, uniform places in a length of `count` spacings, for particle p on the lattice at p + 1/2.
inline Displacement uniform_places(ParticleIndex count, std::uint64_t seed, std::uint64_t replica) {
  const detail::Displacements all = detail::displacements(count);
  std::int64_t sum = 0;
  for (std::int64_t& place : *all) place = sum += exponential_gap(seed, replica, &place - all->data());
  sum += exponential_gap(seed, replica, count);
  // One unit of every gap is kept, so that no two places are the same.
  const std::int64_t shared = count * displacement_unit - count - 1;
  for (ParticleIndex particle = 0; particle < count; ++particle) {
    std::int64_t& place = (*all)[static_cast<std::size_t>(particle)];
    place = detail::share_of(place, shared, sum) + (particle + 1) - (2 * particle + 1) * (displacement_unit / 2);
  }
  return detail::looked_up(all);
}

}  // namespace cradle
