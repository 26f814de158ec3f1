#include "cradle/tools/support/time_left.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace cradle::tools {

namespace {

constexpr double least_seconds = 2;       // of computing, before anything is predicted
constexpr double agreement = 1.5;         // of predictions made at different moments
constexpr std::size_t most_points = 512;  // then every second one is dropped

using Points = std::vector<std::pair<double, double>>;

// The simulated time after so many seconds, between points linearly.
double time_at(const Points& points, double seconds) {
  const auto after = std::lower_bound(points.begin(), points.end(), std::pair(seconds, 0.0),
                                      [](const auto& a, const auto& b) { return a.first < b.first; });
  if (after == points.begin()) return points.front().second;
  if (after == points.end()) return points.back().second;
  const auto before = after - 1;
  const double share = (seconds - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

// The seconds of the whole run as they would have been predicted after `seconds`; nothing if the run did not advance.
std::optional<double> total(const Points& points, double seconds, double end) {
  const double begin = points.front().first, quarter = (seconds - begin) / 4;
  const std::array<double, 3> time{time_at(points, seconds - 2 * quarter), time_at(points, seconds - quarter),
                                   time_at(points, seconds)};
  if (!(time[0] < time[1] && time[1] < time[2])) return std::nullopt;
  const double earlier = quarter / (time[1] - time[0]), later = quarter / (time[2] - time[1]);
  const double slope = (later - earlier) / ((time[2] - time[0]) / 2), rest = end - time[2];
  // From the middle of the last quarter to the middle of the rest; a cost that falls is not extrapolated.
  const double cost = later + std::max(slope, 0.0) * ((time[2] - time[1]) + rest) / 2;
  return seconds + cost * rest;
}

}  // namespace

void TimeLeft::add(double seconds, double time) {
  if (!points_.empty() && !(seconds > points_.back().first && time >= points_.back().second)) return;
  points_.emplace_back(seconds, time);
  if (points_.size() < most_points) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points_.size(); k += 2) points_[kept++] = points_[k];
  if (points_.size() % 2 == 0) points_[kept++] = points_.back();
  points_.resize(kept);
}

std::optional<double> TimeLeft::until(double end) const {
  if (points_.size() < 2) return std::nullopt;
  const double begin = points_.front().first, now = points_.back().first;
  if (now - begin < least_seconds) return std::nullopt;
  double least = 0, most = 0;
  for (const double share : {1.0, 0.75, 0.5}) {
    const auto found = total(points_, begin + share * (now - begin), end);
    if (!found) return std::nullopt;
    least = most > 0 ? std::min(least, *found) : *found;
    most = std::max(most, *found);
  }
  if (most > agreement * least) return std::nullopt;
  return std::max(*total(points_, now, end) - now, 0.0);
}

}  // namespace cradle::tools
