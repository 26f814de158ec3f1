#pragma once
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

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "cradle/core/observe/clusters.hpp"

namespace cradle {

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
    return std::tie(self.established, self.first_meeting, self.first_passed, self.passes, self.sticks,
                    self.role_changes, self.regime);
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

  static auto state(auto& self) { return std::tie(self.pair_, self.meeting_, self.largest_, self.found_); }

 private:
  struct Meeting {
    double time;
    std::uint64_t merges_before;
    static auto state(auto& self) { return std::tie(self.time, self.merges_before); }
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
