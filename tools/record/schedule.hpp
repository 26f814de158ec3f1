// When a run is sampled: the times of the series, snapshots and other outputs of a scene, and their union, in the
// working precision.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "cradle/tools/model/initial_state.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

template <Real T> struct Schedule {
  std::vector<T> series, snapshots, profiles, masses, zone, averages, counting;  // each increasing
  std::vector<T> correlations, structure, structure_at, pairs, pairs_at;
  std::vector<T> stops;  // their union
};

template <Real T> bool holds(const std::vector<T>& times, const T& time) {
  return std::binary_search(times.begin(), times.end(), time);
}

/// Logarithmic spacing starts at this share of the run: six points per decade would need 36 for it.
inline constexpr double first_log_share = 1e-6;

template <Real T> std::vector<T> times_from(const T& start, const T& until, const T& step) {
  std::vector<T> times;
  for (std::int64_t k = 0;; ++k) {
    const T time = start + T(k) * step;
    if (time > until) return times;
    times.push_back(time);
  }
}

template <Real T> std::vector<T> series_times(const Series& series, const T& start, const T& until) {
  std::vector<T> times;
  if (!series.times.empty()) {
    for (const auto& time : series.times) times.push_back(number<T>(time));
  } else if (series.every) {
    times = times_from(start, until, number<T>(*series.every));
  } else {
    const auto points = static_cast<std::int64_t>(*series.points);
    const T end = series.over ? number<T>(*series.over) : until, span = end - start;
    const auto at = [&](std::int64_t k) {
      if (k + 1 == points) return end;
      if (series.spacing == Spacing::linear) return T(start + span * T(k) / T(points - 1));
      if (k == 0) return start;
      // Shares of the span are computed in double, so that the times are the same in every precision.
      const double part = static_cast<double>(k - 1) / static_cast<double>(std::max<std::int64_t>(points - 2, 1));
      return T(start + span * from_text<T>(fmt::format("{}", std::pow(first_log_share, 1 - part))));
    };
    for (std::int64_t k = 0; k < points || at(k) < until; ++k) times.push_back(at(k));
    if (times.back() < until) times.push_back(until);
  }
  // Times that the type cannot distinguish become one.
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

template <Real T> Schedule<T> schedule(const Scene& scene) {
  const T start = number<T>(scene.run.start), until = number<T>(scene.run.until);
  const Output& output = scene.output;
  Schedule<T> plan;
  plan.series = series_times(output.series, start, until);
  const auto at = [](const std::vector<Decimal>& decimals) {
    std::vector<T> times;
    for (const Decimal& time : decimals) times.push_back(number<T>(time));
    return times;
  };
  plan.snapshots = at(output.snapshots);
  plan.profiles = at(output.profiles.times);
  plan.masses = at(output.masses);
  plan.structure_at = at(output.structure.times);
  plan.pairs_at = at(output.pair_distribution.times);
  const Zone& zone = output.zone;
  if (zone.from) {
    const T from = number<T>(*zone.from);
    const auto samples = static_cast<std::int64_t>(zone.samples);
    for (std::int64_t k = 0; k < samples; ++k) plan.zone.push_back(from + (until - from) * T(k) / T(samples));
  }
  const auto every = [](const auto& plan_of) {
    if (!plan_of.every) return std::vector<T>();
    auto times = times_from(number<T>(plan_of.from), number<T>(plan_of.until), number<T>(*plan_of.every));
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
  };
  plan.averages = every(output.averages);
  plan.counting = every(output.counting);
  plan.correlations = every(output.correlations);
  plan.structure = every(output.structure);
  plan.pairs = every(output.pair_distribution);
  for (const auto* times :
       {&plan.series, &plan.snapshots, &plan.profiles, &plan.masses, &plan.zone, &plan.averages, &plan.counting,
        &plan.correlations, &plan.structure, &plan.structure_at, &plan.pairs, &plan.pairs_at})
    plan.stops.insert(plan.stops.end(), times->begin(), times->end());
  plan.stops.push_back(until);
  std::sort(plan.stops.begin(), plan.stops.end());
  plan.stops.erase(std::unique(plan.stops.begin(), plan.stops.end()), plan.stops.end());
  return plan;
}

/// The decimal of the scene for a sample of the series; nothing if the scene gives no decimal.
template <Real T>
std::optional<Decimal> series_decimal(const Scene& scene, const std::vector<T>& times, const T& time) {
  const Series& series = scene.output.series;
  // Times that the type cannot distinguish are merged, so the decimal may be further back in its list.
  auto k = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  const T start = number<T>(scene.run.start);
  if (!series.times.empty()) {
    while (number<T>(series.times[k]) < time) ++k;
    return series.times[k];
  }
  if (series.every) {
    const T step = number<T>(*series.every);
    while (T(start + T(static_cast<std::int64_t>(k)) * step) < time) ++k;
    return stepped(scene.run.start, k, *series.every);
  }
  if (k == 0) return scene.run.start;
  for (const Decimal& end : {series.over.value_or(scene.run.until), scene.run.until})
    if (number<T>(end) == time) return end;
  return {};
}

/// The decimal times that this stop of a run stands for.
template <Real T>
std::vector<RequestedTime> requested_times(const Scene& scene, const Schedule<T>& plan, const T& time) {
  std::vector<RequestedTime> all;
  const Decimal own(to_text(time));
  const auto at = [&](const Decimal& decimal) -> RequestedTime& {
    for (RequestedTime& asked : all)
      if (asked.time == decimal) return asked;
    return all.emplace_back(decimal);
  };
  if (holds(plan.series, time)) at(series_decimal(scene, plan.series, time).value_or(own)).of_series = true;
  if (holds(plan.snapshots, time)) {
    const auto first = std::lower_bound(plan.snapshots.begin(), plan.snapshots.end(), time);
    at(scene.output.snapshots[static_cast<std::size_t>(first - plan.snapshots.begin())]).of_snapshots = true;
  }
  if (time == plan.stops.back()) at(scene.run.until).last = true;
  if (all.empty()) at(own);
  return all;
}

template <class T> PlannedTimes planned_in(const Scene& scene) {
  const Schedule<T> plan = schedule<T>(scene);
  const auto rounded = [](const std::vector<T>& all) {
    std::vector<double> times;
    for (const T& time : all) times.push_back(to_double(time));
    return times;
  };
  return {rounded(plan.series), rounded(plan.profiles), rounded(plan.structure_at), rounded(plan.pairs_at),
          to_double(plan.stops.back())};
}

}  // namespace cradle::tools
