#pragma once
// Replicas whose values are difficult for the arithmetic of statistics.

#include <numeric>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/ensemble/tree.hpp"

namespace cradle::test {

inline constexpr std::size_t entries = 5;

// Uniform in [-1, 1) times scales from 1 to 1e12, plus an offset for which naive sums of squares cancel.
inline std::vector<double> values_of(ReplicaIndex k) {
  std::vector<double> values;
  for (std::size_t i = 0; i < entries; ++i) {
    const auto bits = static_cast<std::int64_t>(random_bits(7, k, i));
    values.push_back(1e6 + static_cast<double>(bits) * 0x1p-63 * std::pow(1e3, static_cast<double>(i)));
  }
  return values;
}

inline std::vector<ReplicaIndex> first_indices(std::uint64_t n) {
  std::vector<ReplicaIndex> all(n);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

inline Moments statistics_of(const std::vector<ReplicaIndex>& replicas) {
  MomentTree tree;
  for (const ReplicaIndex k : replicas) tree.add(k, values_of(k));
  return tree.total();
}

}  // namespace cradle::test
