#pragma once
// The distribution of the values of an entry over replicas: counts in fixed bins of equal width, and quantiles from
// them. Counts are integers and add exactly, in any order. The error of a quantile is at most the width of a bin.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace cradle {

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
  static auto state(auto& self) { return std::tie(self.from, self.to, self.bins); }
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
