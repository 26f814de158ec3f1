// What a run leaves behind: collects samples, configurations, profiles and contacts while it goes on, and puts them
// into the tables of a result file (tables.hpp).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/dense_core.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/tools/run/tables.hpp"

namespace cradle::tools {

template <Real T> T none() { return std::numeric_limits<T>::quiet_NaN(); }

/// Columns of a table, or some of them: numbers of the run's type, and others, which have no more digits than a double.
template <Real T> using Columns = std::vector<std::variant<std::vector<T>, Numbers>>;
template <Real T, class... Values> Columns<T> columns(Values&&... values) {
  Columns<T> all;
  (all.emplace_back(std::forward<Values>(values)), ...);
  return all;
}

template <class Item> void append(std::vector<Item>& all, std::vector<Item>&& more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// Below which those numbers stand that a double does not hold; of doubles there are none.
template <Real T> inline constexpr std::string_view exact_part = std::same_as<T, double> ? "" : exact_folder;

/// Rows of a table as the run has them.
template <Real T> struct Recorded {
  Group table;  // without numbers
  Columns<T> columns;
  std::vector<std::pair<std::string, T>> attributes;
};

/// The same numbers as decimals, all digits of them, below /exact.
template <Real T> Group as_decimals(const Recorded<T>& rows) {
  Group exact{std::string(exact_part<T>) + rows.table.name, {}, {}};
  for (const auto& [name, value] : rows.attributes) exact.attributes.emplace_back(name, to_text(value));
  for (std::size_t k = 0; k < rows.columns.size(); ++k) {
    const auto* values = std::get_if<std::vector<T>>(&rows.columns[k]);
    if (values == nullptr) continue;
    std::vector<std::string> texts;
    for (const T& value : *values) texts.push_back(to_text(value));
    Column& column = exact.columns.emplace_back(rows.table.columns.at(k));
    column.values = std::move(texts);
  }
  return exact;
}

/// Rounded to float64: here, at the last moment.
template <Real T> Group as_doubles(Recorded<T>&& rows) {
  const auto rounded = [](auto& values) -> Numbers {
    if constexpr (std::same_as<std::decay_t<decltype(values)>, Numbers> || std::same_as<T, double>) {
      return std::move(values);
    } else {
      std::vector<double> doubles;
      doubles.reserve(values.size());
      // Types have NaN of either sign.
      for (const T& value : values) doubles.push_back(value == value ? to_double(value) : none<double>());
      return doubles;
    }
  };
  std::vector<Numbers> all;
  for (auto& column : rows.columns) all.push_back(std::visit(rounded, column));
  for (const auto& [name, value] : rows.attributes) rows.table.attributes.emplace_back(name, to_double(value));
  return filled(std::move(rows.table), std::move(all));
}

/// What a result holds of them; `exact`: with decimals where the type has more digits than a double.
template <Real T> std::vector<Group> tables(Recorded<T>&& rows, bool exact) {
  std::vector<Group> all;
  if (!exact_part<T>.empty() && exact) all.push_back(as_decimals(rows));
  all.push_back(as_doubles(std::move(rows)));
  return all;
}

/// What was in it, which is empty afterwards.
template <class Numbers> Numbers taken(Numbers& numbers) { return std::exchange(numbers, Numbers()); }

/// The time series.
template <Real T> class SeriesRecorder {
 public:
  void add(const Sample<T>& s) {
    time_.push_back(s.time);
    energy_.push_back(s.energy);
    lost_.push_back(s.energy_lost);
    given_.push_back(s.given);
    contacts_.push_back(s.counts.contacts);
    below_.push_back(s.counts.below_cutoff);
    merges_.push_back(s.counts.merges);
    bodies_.push_back(static_cast<std::uint64_t>(s.bodies));
    left_.push_back(s.front_left.value_or(none<T>()));
    right_.push_back(s.front_right.value_or(none<T>()));
  }

  std::size_t rows() const { return time_.size(); }
  /// The rows since it was called last, of the columns that every series has; `walled`: and what walls have given.
  Columns<T> take(bool walled) {
    Columns<T> all = columns<T>(taken(time_), taken(energy_), taken(lost_), taken(contacts_), taken(below_),
                                taken(merges_), taken(bodies_), taken(left_), taken(right_));
    std::vector<T> given = taken(given_);
    if (walled) append(all, columns<T>(std::move(given)));
    return all;
  }

 private:
  std::vector<T> time_, energy_, lost_, given_, left_, right_;
  std::vector<std::uint64_t> contacts_, below_, merges_, bodies_;
};

/// The two heaviest clusters and the cloud, beside the series.
template <Real T> class CloudRecorder {
 public:
  void add(const Cloud<T>& cloud) {
    for (const auto* cluster : {&cloud.left, &cloud.right}) {
      mass_.push_back(*cluster ? (*cluster)->mass : none<T>());
      x_.push_back(*cluster ? (*cluster)->x : none<T>());
      v_.push_back(*cluster ? (*cluster)->v : none<T>());
      index_.push_back(*cluster ? static_cast<std::uint64_t>((*cluster)->index) : no_body);
    }
    cloud_mass_.push_back(cloud.mass);
    cloud_width_.push_back(cloud.width);
  }

  /// Of the series, and the table below it, since they were called last.
  Columns<T> take() { return columns<T>(taken(cloud_mass_), taken(cloud_width_)); }
  Recorded<T> take_heaviest() {
    return {heaviest_table(), columns<T>(taken(mass_), taken(x_), taken(v_), taken(index_)), {}};
  }

 private:
  static constexpr std::uint64_t no_body = std::numeric_limits<std::uint64_t>::max();
  std::vector<T> mass_, x_, v_, cloud_mass_, cloud_width_;
  std::vector<std::uint64_t> index_;
};

/// The dense core, and the sticky gas that a shock is compared with, beside the series.
template <Real T> class CoreRecorder {
 public:
  CoreRecorder(std::shared_ptr<const cradle::Bodies<T>> bodies, const T& start)
      : bodies_(std::move(bodies)), start_(start) {}

  void add(const Configuration<T>& c, const T& lost) {
    const DenseCore core = dense_core(c);
    mass_.push_back(core.mass);
    width_.push_back(core.width);
    window_.push_back(core.window);
    gap_.push_back(core.gap);
    StickyGas<T> sticky(bodies_, start_);  // anew: what it gives must not depend on when it was looked at before
    sticky.advance(c.time);
    const T energy = bodies_->kinetic_energy();  // of both ledgers: what they share cancels
    excess_.push_back(T(T(energy - lost) - (energy - sticky.energy_lost())));
  }
  Columns<T> take() { return columns<T>(taken(mass_), taken(width_), taken(window_), taken(gap_), taken(excess_)); }

 private:
  std::shared_ptr<const cradle::Bodies<T>> bodies_;
  T start_;
  std::vector<double> mass_, width_, window_, gap_;
  std::vector<T> excess_;
};

/// How many clusters there are of which mass.
template <Real T> Group masses_table(const Configuration<T>& c, const T& least_mass, const std::string& name) {
  std::vector<std::uint64_t> clusters = mass_distribution(c, least_mass);
  std::vector<double> from;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    from.push_back(to_double(least_mass) * std::exp2(static_cast<double>(k) / 4));
  Group table = filled(masses_table(name), std::move(from), std::move(clusters));
  table.attributes = {{"time", to_double(c.time)}};
  return table;
}

/// All active bodies at a time.
template <Real T> Recorded<T> snapshot_rows(const Configuration<T>& c, const std::string& name) {
  std::vector<std::uint64_t> index(c.index.begin(), c.index.end());
  Recorded<T> rows{
      snapshot_table(name), columns<T>(c.x, c.v, c.m, std::move(index), c.gap, c.closing_speed), {{"time", c.time}}};
  if (c.x.size() < 2) return rows;
  const GapStatistics<T> gaps = gap_statistics(c);
  rows.attributes.emplace_back("gap_min", gaps.least);
  rows.attributes.emplace_back("gap_median", gaps.median);
  if (c.closure_gap) rows.attributes.emplace_back("closure_gap", *c.closure_gap);
  if (c.closure_speed) rows.attributes.emplace_back("closure_speed", *c.closure_speed);
  return rows;
}

inline Group profile_table(Profile&& p, const std::string& name) {
  Group table = filled(profile_table(name), std::move(p.x), std::move(p.velocity), std::move(p.density),
                       std::move(p.mass_density), std::move(p.temperature), std::move(p.density_right),
                       std::move(p.velocity_right), std::move(p.density_left), std::move(p.velocity_left));
  table.attributes = {{"time", p.time}};
  return table;
}

/// Every contact, where a scene asks for them.
template <Real T> class EventRecorder {
 public:
  void operator()(const Contact<T>& c) {
    left_.push_back(static_cast<std::uint64_t>(c.left));
    right_.push_back(static_cast<std::uint64_t>(c.right));
    const T time = c.time.value();
    time_.push_back(time);
    low_.push_back(to_double(difference(c.time, Pair<T>{T(rounded(time)), T(0)})));
    interval_.push_back(c.interval);
    speed_.push_back(c.closing_speed);
  }

  std::size_t rows() const { return left_.size(); }
  /// The rows since it was called last.
  Recorded<T> take() {
    return {events_table(),
            columns<T>(taken(left_), taken(right_), taken(time_), taken(low_), taken(interval_), taken(speed_)),
            {}};
  }

 private:
  // The number of type T that the double nearest to `time` stands for.
  static T rounded(const T& time) {
    if constexpr (std::same_as<T, double>)
      return time;
    else
      return T(to_double(time));
  }

  std::vector<std::uint64_t> left_, right_;
  std::vector<T> time_, interval_, speed_;
  std::vector<double> low_;
};

}  // namespace cradle::tools
