// When a run is sampled: the times of the series, snapshots and other outputs of a scene, and their union, in the
// working precision.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/record/times.hpp"
#include "cradle/tools/setup/initial_state.hpp"

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

/// When a measurement is due: the times of its samples, and those of its tables.
template <Real T> struct MeasurementTimes { Times<T> samples, tables; };
/// What of it is due at one time.
struct Due {
  bool sample = false;
  std::optional<double> table;  // its time
  explicit operator bool() const { return sample || table; }
};

/// All times at which a run is recorded are made here.
template <Real T> struct Schedule {
  std::vector<MeasurementTimes<T>> of;  // as measurement_rows() has them
  Times<T> end;
  std::vector<T> stops;  // their union

  const Times<T>& series() const { return of[row_number("series")].samples; }
  const Times<T>& snapshots() const { return of[row_number("snapshots")].tables; }
  Due due(std::size_t row, const T& time) const {
    const auto table = of[row].tables.find(time);
    return {of[row].samples.hold(time), table ? std::optional(table->rounded) : std::nullopt};
  }
  template <class F> void for_each(F f) const {
    for (const MeasurementTimes<T>& each : of) f(each.samples), f(each.tables);
    f(end);
  }
  /// What a time of a run means: the decimal of the scene, or, of a collision, itself.
  Given<T> meant(const T& time) const {
    std::optional<Given<T>> found;
    for_each([&](const Times<T>& times) {
      if (!found) found = times.find(time);
    });
    return found ? *found : Given<T>(time);
  }
};

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

template <Real T> Schedule<T> schedule(const Scene& scene) {
  Schedule<T> plan;
  for (const MeasurementRow* row : measurement_rows())
    plan.of.push_back({row->samples ? times_of<T>(row->samples(scene)) : Times<T>(),
                       row->times ? times_of<T>(row->times(scene.output)) : Times<T>()});
  plan.end.push_back(scene.run.until.text);
  plan.for_each([&](const Times<T>& times) {
    plan.stops.insert(plan.stops.end(), times.values().begin(), times.values().end());
  });
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
  if (const auto found = plan.series().find(time)) {
    const Decimal decimal(plan.series().decimal(time));
    const bool written = !series.points || decimal == scene.run.start || decimal == scene.run.until ||
                         (series.over && decimal == *series.over);
    at(written ? decimal : Decimal(found->text)).of_series = true;
  }
  if (plan.snapshots().hold(time)) at(Decimal(plan.snapshots().decimal(time))).of_snapshots = true;
  if (time == plan.stops.back()) at(scene.run.until).last = true;
  if (all.empty()) at(Decimal(plan.meant(time).text));
  return all;
}

template <class T> PlannedTimes planned_in(const Scene& scene) {
  const Schedule<T> plan = schedule<T>(scene);
  PlannedTimes times{plan.series().rounded(), {}, scene.run.until.value};
  for (const MeasurementTimes<T>& each : plan.of) times.tables.push_back(each.tables.rounded());
  return times;
}

}  // namespace cradle::tools
