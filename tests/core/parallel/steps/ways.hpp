#pragma once
// What the tests of steps share, whatever the numbers: runs in segments with steps, which must have the bits of the
// plain loop in every gap, closing speed, local time, lag and loss, and in what walls gave.

#include <gtest/gtest.h>

#include <concepts>
#include <string>
#include <vector>

#include "cradle/core/initial/walled.hpp"
#include "cradle/core/parallel/steps/steps.hpp"
#include "cradle/tests/core/segmented.hpp"

namespace cradle::test {

// On each kind of vectors that this processor has.
inline std::vector<SegmentsAs> on_all_vectors(Segmentation how, unsigned threads) {
  std::vector<SegmentsAs> ways;
  for (const Steps& steps : all_steps()) {
    ways.push_back({how, threads});
    ways.back().how.steps = &steps;
  }
  return ways;
}

// Every segmentation on the widest vectors, and one on each other kind.
inline std::vector<SegmentsAs> all_ways() {
  std::vector<SegmentsAs> ways = segmentations();
  for (SegmentsAs& as : ways) as.how.steps = &all_steps().front();
  for (std::size_t k = 1; k < all_steps().size(); ++k) {
    ways.push_back(segmentations()[k % segmentations().size()]);
    ways.back().how.steps = &all_steps()[k];
  }
  return ways;
}

template <class Chain, class Law, class Time = int>
SlabsMade expect_same_in_steps(const Scene<typename Chain::Scalar>& scene, const Law& law,
                               const std::vector<Time>& times, const std::vector<SegmentsAs>& ways) {
  const std::vector<typename Chain::Scalar> in_scalar(times.begin(), times.end());
  return expect_same_in_segments<Chain>(scene, law, ways, in_scalar, SameBits());
}

template <class Chain>
void expect_same_by_all_laws(const Scene<typename Chain::Scalar>& scene, const std::vector<int>& times,
                             double least_in_steps) {
  SlabsMade all;
  const auto check = [&](const std::string& name, const auto& law) {
    SCOPED_TRACE(name);
    all += expect_same_in_steps<Chain>(scene, law, times, all_ways());
  };
  for (const auto& law : laws<typename Chain::Scalar>())
    check("restitution " + std::to_string(to_double(law.restitution())), law);
  if constexpr (std::same_as<Chain, GapChain<double, IndividualMasses<double>>>)
    check("of the speed", SpeedDependent<double>(0.8, 0.1, 0.6));
  EXPECT_GT(all.slabs, 100U);
  EXPECT_GE(static_cast<double>(all.in_steps), least_in_steps * static_cast<double>(all.collisions));
}

// A cool wall on the right, and on the left a heated one or, of unequal particles, one that moves.
template <class Chain> void expect_same_between_walls(const std::vector<int>& times, double least_in_steps) {
  using T = typename Chain::Scalar;
  const bool unequal = !std::same_as<Chain, GapChain<T>>;
  const Wall<T> hot{.position = T(-1), .temperature = 0.4, .seed = 5, .replica = 2};
  const Wall<T> moving{.position = T(-1), .speed = T(1) / T(10), .restitution = T(9) / T(10)};
  const Wall<T> cool{.position = T(801), .temperature = 0.1, .seed = 5, .replica = 2};
  const auto scene = std::make_shared<Walled<T>>(gas<T>(800, T(0), unequal), unequal ? moving : hot, cool);
  expect_same_by_all_laws<Chain>(scene, times, least_in_steps);
}

}  // namespace cradle::test
