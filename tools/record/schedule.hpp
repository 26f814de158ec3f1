// When a run is sampled: the times of the series, snapshots and other outputs of a scene, and their union, in the
// working precision.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/tools/setup/initial_state.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/times.hpp"

namespace cradle::tools {

/// Increasing times and the decimals that they mean. Times that the type cannot distinguish become one, the first.
template <Real T> class Times {
 public:
  void push_back(std::string_view decimal) {
    T time = from_text<T>(decimal);
    if (!times_.empty() && !(times_.back() < time)) return;
    times_.push_back(std::move(time));
    decimals_.push_back(decimal);
  }
  const std::vector<T>& values() const { return times_; }
  std::size_t size() const { return times_.size(); }
  bool empty() const { return times_.empty(); }
  bool hold(const T& time) const { return std::binary_search(times_.begin(), times_.end(), time); }
  std::vector<double> rounded() const {
    std::vector<double> all;
    for (std::size_t k = 0; k < size(); ++k) all.push_back(from_text<double>(decimals_[k]));
    return all;
  }
  std::optional<Given<T>> find(const T& time) const {
    if (!hold(time)) return {};
    return Given<T>(time, decimal(time));
  }
  /// Of a time that is one of these.
  std::string_view decimal(const T& time) const {
    const auto found = std::lower_bound(times_.begin(), times_.end(), time);
    return decimals_[static_cast<std::size_t>(found - times_.begin())];
  }

 private:
  std::vector<T> times_;
  DecimalColumn decimals_;
};

/// All times at which a run is recorded are made here.
template <Real T> struct Schedule {
  Times<T> series, snapshots, profiles, masses, zone, averages, counting, correlations, structure, structure_at, pairs,
      pairs_at, end;
  std::vector<T> stops;  // their union

  auto lists() const {
    return std::array{&series,       &snapshots, &profiles,     &masses, &zone,     &averages, &counting,
                      &correlations, &structure, &structure_at, &pairs,  &pairs_at, &end};
  }
  /// What a time of a run means: the decimal of the scene, or, of a collision, itself.
  Given<T> meant(const T& time) const {
    for (const Times<T>* times : lists())
      if (auto found = times->find(time)) return *found;
    return Given<T>(time);
  }
};

/// Logarithmic spacing starts at this share of the run: six points per decade would need 36 for it.
inline constexpr double first_log_share = 1e-6;

template <Real T> Times<T> times_of(const std::vector<Decimal>& decimals) {
  Times<T> times;
  for (const Decimal& time : decimals) times.push_back(time.text);
  return times;
}
template <Real T> Times<T> times_of(const DecimalColumn& decimals) {
  Times<T> times;
  for (std::size_t k = 0; k < decimals.size(); ++k) times.push_back(decimals[k]);
  return times;
}

template <Real T> Times<T> series_times(const Scene& scene) {
  const Series& series = scene.output.series;
  const Decimal &start = scene.run.start, &until = scene.run.until;
  if (!series.times.empty()) return times_of<T>(series.times);
  if (series.every) return times_of<T>(decimals_by_step(start, *series.every, until));
  const std::uint64_t points = *series.points;
  const Decimal end = series.over.value_or(until);
  Times<T> times;
  if (!(start < end)) {
    times.push_back(start.text);
  } else if (series.spacing == Spacing::linear) {
    times = times_of<T>(decimals_by_parts(start, end, points - 1, until, scene.run.decimal_digits()));
  } else {
    times.push_back(start.text);
    for (std::uint64_t k = 1;; ++k) {
      // Shares of the span are computed in double, so that the times are the same in every precision.
      const double part = static_cast<double>(k - 1) / static_cast<double>(std::max<std::uint64_t>(points - 2, 1));
      const auto share = fmt::format("{}", k + 1 == points ? 1. : std::pow(first_log_share, 1 - part));
      const Decimal time = decimal_between(start, end, Decimal(share));
      if (time > until) break;
      times.push_back(time.text);
    }
  }
  times.push_back(until.text);
  return times;
}

template <Real T> Schedule<T> schedule(const Scene& scene) {
  const Output& output = scene.output;
  const auto every = [](const auto& wanted) {
    if (!wanted.every) return Times<T>();
    return times_of<T>(decimals_by_step(wanted.from, *wanted.every, wanted.until));
  };
  Schedule<T> plan;
  plan.series = series_times<T>(scene);
  plan.snapshots = times_of<T>(output.snapshots);
  plan.profiles = times_of<T>(output.profiles.times);
  plan.masses = times_of<T>(output.masses);
  plan.structure_at = times_of<T>(output.structure.times);
  plan.pairs_at = times_of<T>(output.pair_distribution.times);
  if (const Zone& zone = output.zone; zone.from && *zone.from < scene.run.until) {
    const Decimal& until = scene.run.until;
    const DecimalColumn all = decimals_by_parts(*zone.from, until, zone.samples, until, scene.run.decimal_digits());
    for (std::size_t k = 0; k < zone.samples; ++k) plan.zone.push_back(all[k]);
  } else if (zone.from) {
    plan.zone.push_back(zone.from->text);
  }
  plan.averages = every(output.averages);
  plan.counting = every(output.counting);
  plan.correlations = every(output.correlations);
  plan.structure = every(output.structure);
  plan.pairs = every(output.pair_distribution);
  plan.end.push_back(scene.run.until.text);
  for (const Times<T>* times : plan.lists())
    plan.stops.insert(plan.stops.end(), times->values().begin(), times->values().end());
  std::sort(plan.stops.begin(), plan.stops.end());
  plan.stops.erase(std::unique(plan.stops.begin(), plan.stops.end()), plan.stops.end());
  return plan;
}

/// The decimal times that this stop of a run stands for. Points between the ends of a series need not be decimals: they
/// are the run's own times.
template <Real T>
std::vector<RequestedTime> requested_times(const Scene& scene, const Schedule<T>& plan, const T& time) {
  std::vector<RequestedTime> all;
  const auto at = [&](const Decimal& decimal) -> RequestedTime& {
    for (RequestedTime& asked : all)
      if (asked.time == decimal) return asked;
    return all.emplace_back(decimal);
  };
  const Series& series = scene.output.series;
  if (const auto found = plan.series.find(time)) {
    const Decimal decimal(plan.series.decimal(time));
    const bool written = !series.points || decimal == scene.run.start || decimal == scene.run.until ||
                         (series.over && decimal == *series.over);
    at(written ? decimal : Decimal(found->text)).of_series = true;
  }
  if (plan.snapshots.hold(time)) at(Decimal(plan.snapshots.decimal(time))).of_snapshots = true;
  if (time == plan.stops.back()) at(scene.run.until).last = true;
  if (all.empty()) at(Decimal(plan.meant(time).text));
  return all;
}

template <class T> PlannedTimes planned_in(const Scene& scene) {
  const Schedule<T> plan = schedule<T>(scene);
  return {plan.series.rounded(), plan.profiles.rounded(), plan.structure_at.rounded(), plan.pairs_at.rounded(),
          scene.run.until.value};
}

}  // namespace cradle::tools
