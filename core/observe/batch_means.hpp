#pragma once
// Means from batches, with errors. Batches of samples follow each other in time, batches of particles beside each other
// on the line. The error is that of the jackknife over batches, (B - 1)/B sum_b (f_b - mean)^2, f_b being the mean
// without batch b; for batches of equal weight it is the error from batch means (Flyvbjerg and Petersen, J. Chem. Phys.
// 91, 461, 1989). It holds if batches are longer than what is correlated: then four joined to one give the same.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "cradle/core/base/state.hpp"

namespace cradle {

inline constexpr std::size_t mean_batches = 32;
using OfBatches = std::array<double, mean_batches>;

struct BatchMean {
  double mean, error;
  double rough_error;  // from a quarter as many batches
};

namespace detail {

// Of a number f, from its values without each batch; NaN for fewer than two.
inline double jackknife_error(const std::vector<double>& without) {
  const auto count = static_cast<double>(without.size());
  if (count < 2) return std::numeric_limits<double>::quiet_NaN();
  double mean = 0, squares = 0;
  for (const double value : without) mean += value / count;
  for (const double value : without) squares += (value - mean) * (value - mean);
  return std::sqrt(squares * (count - 1) / count);
}

inline double jackknife_error(const OfBatches& sums, const OfBatches& weights, std::size_t joined) {
  double sum = 0, weight = 0;
  for (std::size_t b = 0; b < mean_batches; ++b) sum += sums[b], weight += weights[b];
  std::vector<double> without;
  for (std::size_t b = 0; b < mean_batches; b += joined) {
    double s = 0, w = 0;
    for (std::size_t k = b; k < b + joined; ++k) s += sums[k], w += weights[k];
    if (w > 0) without.push_back((sum - s) / (weight - w));
  }
  return jackknife_error(without);
}

}  // namespace detail

// `sums` of what is averaged, `weights` of how much there is; batches of weight 0 are left out. NaN without any.
inline BatchMean mean_of_batches(const OfBatches& sums, const OfBatches& weights) {
  double sum = 0, weight = 0;
  for (std::size_t b = 0; b < mean_batches; ++b) sum += sums[b], weight += weights[b];
  return {weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN(),
          detail::jackknife_error(sums, weights, 1), detail::jackknife_error(sums, weights, 4)};
}

// Ratio of errors from a quarter as many batches to those from all: 1 if batches are longer than what is correlated.
// NaN if none can be joined: of up to 8 samples or particles no two are in neighbouring batches, and both errors are
// one.
inline double error_growth(const std::vector<BatchMean>& means) {
  double rough = 0, fine = 0;
  for (const BatchMean& m : means)
    if (std::isfinite(m.error) && std::isfinite(m.rough_error) && m.rough_error != m.error)
      rough += m.rough_error * m.rough_error, fine += m.error * m.error;
  return fine > 0 ? std::sqrt(rough / fine) : std::numeric_limits<double>::quiet_NaN();
}

// Means over samples of a list of numbers, in batches of equal length.
class SampledMeans {
 public:
  // `samples` will be added, of so many numbers each.
  SampledMeans(std::size_t numbers, std::size_t samples) : samples_(samples), sums_(numbers * mean_batches) {}

  // A sample that has none of the numbers, which are NaN, is left out.
  void add(const std::vector<double>& sample) {
    const std::size_t batch = taken_++ * mean_batches / samples_;
    if (std::ranges::any_of(sample, [](double number) { return std::isnan(number); })) return;
    for (std::size_t k = 0; k < sample.size(); ++k) sums_[k * mean_batches + batch] += sample[k];
    weights_.at(batch) += 1;
  }
  bool empty() const { return taken_ == 0; }
  std::size_t samples() const {
    return static_cast<std::size_t>(std::accumulate(weights_.begin(), weights_.end(), 0.));
  }
  bool complete() const { return taken_ == samples_; }
  std::vector<BatchMean> means() const {
    std::vector<BatchMean> all;
    OfBatches sums, weights;
    for (std::size_t b = 0; b < mean_batches; ++b) weights[b] = weights_[b];
    for (std::size_t k = 0; k < sums_.size(); k += mean_batches) {
      for (std::size_t b = 0; b < mean_batches; ++b) sums[b] = sums_[k + b];
      all.push_back(mean_of_batches(sums, weights));
    }
    return all;
  }

  static auto state(auto& self) { return fields(self.taken_, self.weights_, self.sums_); }
  void loaded() const {
    require_state(taken_ <= samples_ && weights_.size() == mean_batches && sums_.size() == numbers_, "samples");
  }

 private:
  std::size_t samples_, taken_ = 0;
  std::vector<double> weights_ = std::vector<double>(mean_batches), sums_;
  std::size_t numbers_ = sums_.size();
};

}  // namespace cradle
