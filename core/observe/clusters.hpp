#pragma once
// The clusters of a gas whose particles merge: the two heaviest ones, the cloud around them, and the distribution of
// masses. Only particles in the active zone count, from the leftmost that has collided to the rightmost; one that has
// not merged is a cluster of its own. Units of the scene.

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "cradle/core/chains/configuration.hpp"

namespace cradle {

template <Real T> struct Cluster {
  T mass{0}, x{0}, v{0};
  // Initial number of the particle that names it: kept when clusters pass; when they merge, that of the heavier one.
  ParticleIndex index = -1;
};

template <Real T> struct Cloud {
  // The two heaviest clusters in the order of the line; ties go left to right. After they have passed
  // each other the index says which is which.
  std::optional<Cluster<T>> left, right;
  T mass{0};   // of all clusters
  T width{0};  // standard deviation of position, weighted by mass, without the heaviest two; 0 if none are left
};

template <Real T> Cloud<T> cloud(const Configuration<T>& c) {
  Cloud<T> found;
  std::size_t first = c.collided_to, second = c.collided_to;  // heaviest, next
  CompensatedSum<T> mass;
  for (std::size_t j = c.collided_from; j < c.collided_to; ++j) {
    mass.add(c.m[j]);
    if (first == c.collided_to || c.m[j] > c.m[first])
      second = first, first = j;
    else if (second == c.collided_to || c.m[j] > c.m[second])
      second = j;
  }
  found.mass = mass.value();
  if (second == c.collided_to) return found;
  const auto cluster = [&](std::size_t j) { return Cluster<T>{c.m[j], c.x[j], c.v[j], c.index[j]}; };
  found.left = cluster(std::min(first, second));
  found.right = cluster(std::max(first, second));

  T rest(0), mean(0), scatter(0);  // West's update
  for (std::size_t j = c.collided_from; j < c.collided_to; ++j) {
    if (j == first || j == second) continue;
    rest += c.m[j];
    const T from_mean = c.x[j] - mean;
    mean += from_mean * (c.m[j] / rest);
    scatter += c.m[j] * from_mean * (c.x[j] - mean);
  }
  if (is_positive(rest)) found.width = square_root(T(scatter / rest));
  return found;
}

// Entry k: the number of clusters with a mass from 2^(k/4) to below 2^((k+1)/4) times that of the lightest particle.
template <Real T> std::vector<std::uint64_t> mass_distribution(const Configuration<T>& c, const T& least_mass) {
  std::vector<std::uint64_t> clusters;
  for (std::size_t j = c.collided_from; j < c.collided_to; ++j) {
    // A whole mass is at an edge of a bin only if it is a power of two, whose logarithm is exact.
    const double quarters = 4 * std::log2(to_double(T(c.m[j] / least_mass)));
    const auto k = static_cast<std::size_t>(std::max(0.0, std::floor(quarters)));
    if (clusters.size() <= k) clusters.resize(k + 1);
    ++clusters[k];
  }
  return clusters;
}

}  // namespace cradle
