#pragma once
// Mean, spread and extremes of a vector of numbers over replicas, entry by entry, without storing the vectors: count,
// mean, sum of squared deviations from the mean, least and greatest. Two sets of replicas are combined by the pairwise
// update of Chan, Golub and LeVeque (Am. Stat. 37, 242, 1983, doi 10.1080/00031305.1983.10483115), which does not
// cancel. It rounds, so the bits depend on how sets are combined: tree.hpp fixes that.
//
// An entry that a replica does not have (a time after its collapse) is NaN: it is skipped, and counted as missing.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cradle/core/base/fields.hpp"

namespace cradle {

struct Moments {
  std::uint64_t replicas = 0;           // number of vectors
  std::vector<double> mean;             // 0 if no replica has the entry
  std::vector<double> squares;          // sum of squared deviations from the mean
  std::vector<double> least, greatest;  // inf and -inf if no replica has the entry
  std::vector<std::uint64_t> counts;    // replicas that have the entry; empty if all have all

  std::size_t entries() const { return mean.size(); }
  std::uint64_t count(std::size_t entry) const { return counts.empty() ? replicas : counts[entry]; }
  bool complete() const { return counts.empty(); }

  // Standard error of the mean; NaN for fewer than two replicas.
  double standard_error(std::size_t entry) const {
    const auto n = static_cast<double>(count(entry));
    return n < 2 ? std::numeric_limits<double>::quiet_NaN() : std::sqrt(squares[entry] / (n - 1) / n);
  }

  static auto state(auto& self) {
    return fields(self.replicas, self.mean, self.squares, self.least, self.greatest, self.counts);
  }
  bool operator==(const Moments&) const = default;
};

// The moments of one replica, in the memory of others.
inline Moments moments_of(const std::vector<double>& values, Moments one = {}) {
  one.replicas = 1;
  one.squares.assign(values.size(), 0);
  one.mean = one.least = one.greatest = values;
  one.counts.clear();
  for (std::size_t i = 0; i < one.mean.size(); ++i) {
    if (!std::isnan(one.mean[i])) continue;
    if (one.counts.empty()) one.counts.assign(one.mean.size(), 1);
    one.counts[i] = 0;
    one.mean[i] = 0;
    one.least[i] = std::numeric_limits<double>::infinity();
    one.greatest[i] = -std::numeric_limits<double>::infinity();
  }
  return one;
}

namespace detail {

// Two sets of a and b replicas, n = a + b, delta = mean_b - mean_a:
// mean = mean_a + delta b/n, squares = squares_a + squares_b + delta^2 a b/n.
struct Join {
  Join(std::uint64_t left, std::uint64_t right)
      : share(static_cast<double>(right) / (static_cast<double>(left) + static_cast<double>(right))),
        weight(static_cast<double>(left) * share) {}
  void operator()(double& mean, double mean_b, double& squares, double squares_b) const {
    const double delta = mean_b - mean;
    mean += delta * share;
    squares = (squares + squares_b) + delta * delta * weight;
  }
  double share, weight;
};

inline void join_extremes(Moments& left, const Moments& right) {
  const std::size_t n = left.entries();
  for (std::size_t i = 0; i < n; ++i) left.least[i] = right.least[i] < left.least[i] ? right.least[i] : left.least[i];
  for (std::size_t i = 0; i < n; ++i)
    left.greatest[i] = right.greatest[i] > left.greatest[i] ? right.greatest[i] : left.greatest[i];
}

}  // namespace detail

// The moments of both sets. Those without replicas change no bit. Throws std::invalid_argument if lengths differ.
inline Moments combine(Moments left, const Moments& right) {
  if (right.replicas == 0) return left;
  if (left.replicas == 0) return right;
  const std::size_t n = left.entries();
  if (right.entries() != n) throw std::invalid_argument("statistics of vectors of different lengths");
  const detail::Join join_all(left.replicas, right.replicas);
  if (left.complete() && right.complete()) {
    for (std::size_t i = 0; i < n; ++i) join_all(left.mean[i], right.mean[i], left.squares[i], right.squares[i]);
  } else {
    if (left.complete()) left.counts.assign(n, left.replicas);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint64_t of_left = left.counts[i], of_right = right.count(i);
      left.counts[i] += of_right;
      if (of_left == left.replicas && of_right == right.replicas)
        join_all(left.mean[i], right.mean[i], left.squares[i], right.squares[i]);
      else if (of_left > 0 && of_right > 0)
        detail::Join(of_left, of_right)(left.mean[i], right.mean[i], left.squares[i], right.squares[i]);
      else if (of_right > 0)
        left.mean[i] = right.mean[i], left.squares[i] = right.squares[i];
    }
  }
  detail::join_extremes(left, right);
  left.replicas += right.replicas;
  return left;
}

// The distribution of the values of an entry: counts in fixed bins of equal width, and quantiles from them. Counts are
// integers and add exactly, in any order. The error of a quantile is at most the width of a bin.
struct FixedBins {
  double from = 0, to = 1;
  std::size_t bins = 1;

  /// From 1 to bins; 0: below, bins + 1: at `to` or above.
  std::size_t place(double x) const {
    if (x < from) return 0;
    if (!(x < to)) return bins + 1;
    auto bin = std::min(static_cast<std::size_t>((x - from) / (to - from) * static_cast<double>(bins)), bins - 1);
    while (x < edge(bin)) --bin;  // the quotient is rounded in another way than edges
    while (!(x < edge(bin + 1))) ++bin;
    return 1 + bin;
  }
  double edge(std::size_t k) const {
    return k == bins ? to : from + (to - from) * (static_cast<double>(k) / static_cast<double>(bins));
  }
  static auto state(auto& self) { return fields(self.from, self.to, self.bins); }
  bool operator==(const FixedBins&) const = default;
};

/// Counts for each of a number of entries, side by side. NaN is not counted.
class Histograms {
 public:
  Histograms() = default;
  Histograms(FixedBins bins, std::size_t entries) : bins_(bins), counts_(entries * row(), 0) {}

  const FixedBins& bins() const { return bins_; }
  std::size_t entries() const { return counts_.size() / row(); }

  /// Adds one replica's value for every entry.
  void add(std::span<const double> values) {
    if (values.size() != entries()) throw std::invalid_argument("histograms of another number of entries");
    for (std::size_t entry = 0; entry < values.size(); ++entry)
      if (!std::isnan(values[entry])) ++counts_[entry * row() + bins_.place(values[entry])];
  }
  void add(const Histograms& other) {
    if (other.bins_ != bins_ || other.counts_.size() != counts_.size())
      throw std::invalid_argument("histograms with other bins");
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  }

  /// Below the bins, in each of them, above them.
  std::span<const std::uint64_t> counts(std::size_t entry) const { return {counts_.data() + entry * row(), row()}; }
  const std::vector<std::uint64_t>& all_counts() const { return counts_; }
  void set_all_counts(std::vector<std::uint64_t> counts) {
    if (counts.size() != counts_.size()) throw std::invalid_argument("histograms of another number of entries");
    counts_ = std::move(counts);
  }

  /// The value below which a share p of the replicas is, linearly interpolated within the part of a bin between the
  /// least and the greatest value; NaN if there are none or if it is outside the bins.
  double quantile(std::size_t entry, double p, double least = -std::numeric_limits<double>::infinity(),
                  double greatest = std::numeric_limits<double>::infinity()) const {
    const auto of_entry = counts(entry);
    std::uint64_t all = 0;
    for (const std::uint64_t n : of_entry) all += n;
    const double wanted = p * static_cast<double>(all);
    auto below = static_cast<double>(of_entry[0]);
    if (all == 0 || wanted < below) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < bins_.bins; ++k) {
      const auto here = static_cast<double>(of_entry[k + 1]);
      if (here > 0 && wanted <= below + here) {
        const double from = std::max(bins_.edge(k), least), to = std::min(bins_.edge(k + 1), greatest);
        return std::min(from + (to - from) * ((wanted - below) / here), to);
      }
      below += here;
    }
    return std::numeric_limits<double>::quiet_NaN();
  }

  bool operator==(const Histograms&) const = default;

 private:
  std::size_t row() const { return bins_.bins + 2; }

  FixedBins bins_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace cradle
