#include "cradle/tools/record/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

namespace {

// The series may leave out times that are one in the type; what is computed from samples at equal distances may not.
Times samples_of(const MeasurementRow& row, const Scene& scene, Rounding round) {
  if (!row.samples) return {};
  const DecimalColumn decimals = row.samples(scene);
  Times times(decimals, round);
  if (times.size() < decimals.size() && row.of_many_collisions)
    throw Error(scene.place(fmt::format("output.{}", row.name)), "samples at times that are one in this precision",
                fmt::format("{} times of {}", times.size(), decimals.size()),
                "use more digits (run.precision), or an earlier run.start");
  return times;
}

}  // namespace

void Times::push_back(std::string_view decimal, Rounding round) {
  Number time = round(decimal);
  if (!empty() && !(back() < time)) return;
  values_.push_back(time.value);
  if (time.exact) exact_.push_back(std::move(time));
  decimals_.push_back(decimal);
}

std::size_t Times::first_from(const Number& time) const {
  const auto first = std::ranges::lower_bound(values_, time.value) - values_.begin();
  if (exact_.empty()) return static_cast<std::size_t>(first);
  const auto last = std::ranges::upper_bound(values_, time.value) - values_.begin();  // the same as doubles
  return static_cast<std::size_t>(std::lower_bound(exact_.begin() + first, exact_.begin() + last, time) -
                                  exact_.begin());
}

std::vector<double> Times::rounded() const {
  std::vector<double> all;
  for (std::size_t k = 0; k < size(); ++k) all.push_back(from_text<double>(decimals_[k]));
  return all;
}

Schedule::Schedule(const Scene& scene) {
  const Rounding round = rounding(scene);
  for (const MeasurementRow* row : measurement_rows())
    of.push_back({samples_of(*row, scene, round), row->times ? Times(row->times(scene.output), round) : Times()});
  end_.push_back(scene.run.until.text, round);
  for (const MeasurementTimes& each : of)
    for (const Times* times : {&each.samples, &each.tables})
      if (!times->empty()) all_.push_back(times);
  all_.push_back(&end_);
  last_ = end_.back();
  for (const Times* times : all_)
    if (last_ < times->back()) last_ = times->back();
}

Due Schedule::due(std::size_t row, const Number& time) const {
  const auto table = of[row].tables.find(time);
  return {of[row].samples.hold(time), table ? std::optional(table->meant.value) : std::nullopt};
}

RunTime Schedule::meant(const Number& time) const {
  for (const Times* times : all_)
    if (std::optional<RunTime> found = times->find(time)) return *std::move(found);
  return time;
}

std::optional<Number> Schedule::next(const std::optional<Number>& after) const {
  const Times* first = nullptr;
  std::size_t place = 0;
  for (const Times* times : all_) {
    const std::size_t k = after ? times->first_after(*after) : 0;
    if (k < times->size() && (first == nullptr || (*times)[k] < (*first)[place])) first = times, place = k;
  }
  return first == nullptr ? std::nullopt : std::optional((*first)[place]);
}

std::vector<RequestedTime> Schedule::requested(const Scene& scene, const Number& time, bool at_collision) const {
  if (at_collision) return {{Decimal(time.text()), true, false, true}};
  std::vector<RequestedTime> all;
  const auto at = [&](const Decimal& decimal) -> RequestedTime& {
    for (RequestedTime& asked : all)
      if (asked.time == decimal) return asked;
    return all.emplace_back(decimal);
  };
  const Series& wanted = scene.output.series;
  if (const auto found = series().find(time)) {
    const Decimal decimal(series().decimal(time));
    const bool written = !wanted.points || decimal == scene.run.start || decimal == scene.run.until ||
                         (wanted.over && decimal == *wanted.over);
    at(written ? decimal : Decimal(found->meant.text())).of_series = true;
  }
  if (snapshots().hold(time)) at(Decimal(snapshots().decimal(time))).of_snapshots = true;
  if (!(time < last())) at(scene.run.until).last = true;
  if (all.empty()) at(Decimal(meant(time).meant.text()));
  return all;
}

}  // namespace cradle::tools
