#pragma once
// The clusters of a gas whose particles merge: the two heaviest ones, the cloud around them, and the distribution of
// masses. Only particles in the active zone count, from the leftmost that has collided to the rightmost; one that has
// not merged is a cluster of its own. Units of the scene.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/base/fields.hpp"
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
    // Sums of masses are rounded: what is that little below the edge of a bin is at it.
    constexpr double roundings = 1e-9;
    const double quarters = 4 * std::log2(to_double(T(c.m[j] / least_mass))) + roundings;
    const auto k = static_cast<std::size_t>(std::max(0.0, std::floor(quarters)));
    if (clusters.size() <= k) clusters.resize(k + 1);
    ++clusters[k];
  }
  return clusters;
}

// `ScenarioWatch` decides which of the paper's two scenarios a wet shock follows (section VI, Fig. 9). Its two heaviest
// clusters either pass through each other when they meet, and continue to oscillate, or stick, and then another cluster
// becomes the second one. The watch receives every collision, and samples the clusters from time to time.
//
//   pair         the two heaviest clusters, from the first sample in which they hold more than half of the mass that
//                has collided, and at least ten particles each
//   meeting      a collision of the two clusters that were the pair at the last sample: a pass or a stick
//   role change  a sample whose pair differs from that of the sample before
//   regime       apart: these two have not met yet; through: their last meeting was a pass; stuck: it was a stick
//   exponents    powers of time with which the largest separation and the largest speed of the pair grow: one point for
//                each third of a decade since there is a pair, at least four, least squares in the logarithms
//                (theory: (17), 1/3 and -1/3)
// Samples should be spread evenly in the logarithm of time, a hundred per decade or more.
struct Scenario {
  enum class Regime { none, apart, through, stuck };  // none: no pair yet

  double established = std::numeric_limits<double>::quiet_NaN();    // time
  double first_meeting = std::numeric_limits<double>::quiet_NaN();  // time; NaN: none
  bool first_passed = false;                                        // if there was one
  std::uint64_t passes = 0, sticks = 0, role_changes = 0;
  Regime regime = Regime::none;
  double separation_exponent = std::numeric_limits<double>::quiet_NaN();
  double speed_exponent = std::numeric_limits<double>::quiet_NaN();

  // The numbers known before the end.
  static auto state(auto& self) {
    return fields(self.established, self.first_meeting, self.first_passed, self.passes, self.sticks, self.role_changes,
                  self.regime);
  }
};

class ScenarioWatch {
 public:
  // Call it before each collision, with the numbers of its particles and of the merges until then.
  void collision(ParticleIndex left, ParticleIndex right, double time, std::uint64_t merges) {
    settle(merges);
    if (pair_ == std::pair<ParticleIndex, ParticleIndex>(std::minmax(left, right))) meeting_ = {time, merges};
  }

  // Takes a sample when all collisions up to `time` (since the start) are made.
  template <Real T> void sample(const Cloud<T>& cloud, double time, std::uint64_t merges) {
    settle(merges);
    if (!cloud.left || !cloud.right) return;
    const double left = to_double(cloud.left->mass), right = to_double(cloud.right->mass);
    if (!pair_ && !(2 * (left + right) > to_double(cloud.mass) && left >= 10 && right >= 10)) return;
    const std::pair<ParticleIndex, ParticleIndex> now = std::minmax(cloud.left->index, cloud.right->index);
    if (!pair_) {
      found_.established = time;
      found_.regime = Scenario::Regime::apart;
    } else if (*pair_ != now) {
      ++found_.role_changes;
      if (found_.regime == Scenario::Regime::through) found_.regime = Scenario::Regime::apart;
    }
    pair_ = now;
    auto& [separation, speed] = largest_[static_cast<int>(std::floor(3 * std::log10(time)))];
    separation = std::max(separation, to_double(T(cloud.right->x - cloud.left->x)));
    speed = std::max({speed, std::abs(to_double(cloud.left->v)), std::abs(to_double(cloud.right->v))});
  }

  // The result at the end of the run, after so many merges.
  Scenario result(std::uint64_t merges) {
    settle(merges);
    found_.separation_exponent = exponent([](const auto& largest) { return largest.first; });
    found_.speed_exponent = exponent([](const auto& largest) { return largest.second; });
    return found_;
  }

  static auto state(auto& self) { return fields(self.pair_, self.meeting_, self.largest_, self.found_); }

 private:
  struct Meeting {
    double time;
    std::uint64_t merges_before;
    static auto state(auto& self) { return fields(self.time, self.merges_before); }
  };

  // A collision is reported before it is made: the count given with the next one shows whether it was a merge.
  void settle(std::uint64_t merges) {
    if (!meeting_) return;
    const bool passed = merges == meeting_->merges_before;
    if (found_.passes + found_.sticks == 0) {
      found_.first_meeting = meeting_->time;
      found_.first_passed = passed;
    }
    ++(passed ? found_.passes : found_.sticks);
    found_.regime = passed ? Scenario::Regime::through : Scenario::Regime::stuck;
    meeting_.reset();
  }

  // Leaves out the first and the last bin, which the beginning and the end cut short.
  template <class Of> double exponent(Of of) const {
    if (largest_.size() < 6) return std::numeric_limits<double>::quiet_NaN();
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (auto bin = std::next(largest_.begin()); std::next(bin) != largest_.end(); ++bin) {
      const double at = (bin->first + 0.5) / 3, height = std::log10(of(bin->second));
      n += 1, x += at, y += height, xx += at * at, xy += at * height;
    }
    return (n * xy - x * y) / (n * xx - x * x);
  }

  std::optional<std::pair<ParticleIndex, ParticleIndex>> pair_;  // the lower number first
  std::optional<Meeting> meeting_;                               // not settled yet
  std::map<int, std::pair<double, double>> largest_;             // separation and speed, by thirds of a decade
  Scenario found_;
};

}  // namespace cradle
