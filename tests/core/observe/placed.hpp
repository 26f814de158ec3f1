#pragma once
// Configurations of particles placed by hand, and the error of a mean in the plainest way.

#include <cmath>
#include <numeric>
#include <vector>

#include "cradle/core/chains/configuration.hpp"

namespace cradle::test {

// All of them have collided; masses are 1 if none are given.
inline Configuration<double> placed(std::vector<double> x, std::vector<double> v, std::vector<double> m = {}) {
  Configuration<double> c;
  c.x = std::move(x), c.v = std::move(v);
  c.m = m.empty() ? std::vector<double>(c.x.size(), 1.) : std::move(m);
  c.index.resize(c.x.size());
  std::iota(c.index.begin(), c.index.end(), 0);
  c.to = static_cast<ParticleIndex>(c.x.size()) - 1;
  c.collided_to = c.x.size();
  for (std::size_t j = 0; j + 1 < c.x.size(); ++j) c.gap.push_back(c.x[j + 1] - c.x[j]);
  return c;
}

struct PlainMean {
  double mean, error;  // one standard error
};
inline PlainMean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.) / n;
  double squares = 0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n * (n - 1)))};
}

}  // namespace cradle::test
