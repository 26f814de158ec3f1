// What a run leaves behind: collects samples, configurations, profiles and contacts while it goes on, and puts them
// into the tables of a result file (tables.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/dense_core.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/tools/run/tables.hpp"

namespace cradle::tools {

/// Columns of a table, or some of them.
using Columns = std::vector<Numbers>;
template <class... Values> Columns columns(Values&&... values) {
  Columns all;
  (all.emplace_back(std::forward<Values>(values)), ...);
  return all;
}

inline void append(Columns& all, Columns&& more) { std::move(more.begin(), more.end(), std::back_inserter(all)); }

/// What was in it, which is empty afterwards.
template <class Numbers> Numbers taken(Numbers& numbers) { return std::exchange(numbers, Numbers()); }

/// The time series. Numbers are rounded to float64 here, at the last moment.
template <Real T> class SeriesRecorder {
 public:
  void add(const Sample<T>& s) {
    time_.push_back(to_double(s.time));
    energy_.push_back(to_double(s.energy));
    lost_.push_back(to_double(s.energy_lost));
    given_.push_back(to_double(s.given));
    contacts_.push_back(s.counts.contacts);
    below_.push_back(s.counts.below_cutoff);
    merges_.push_back(s.counts.merges);
    bodies_.push_back(static_cast<std::uint64_t>(s.bodies));
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    left_.push_back(s.front_left ? to_double(*s.front_left) : none);
    right_.push_back(s.front_right ? to_double(*s.front_right) : none);
  }

  std::size_t rows() const { return time_.size(); }
  /// The rows since it was called last, of the columns that every series has; `walled`: and what walls have given.
  Columns take(bool walled) {
    Columns all = columns(taken(time_), taken(energy_), taken(lost_), taken(contacts_), taken(below_), taken(merges_),
                          taken(bodies_), taken(left_), taken(right_));
    std::vector<double> given = taken(given_);
    if (walled) append(all, columns(std::move(given)));
    return all;
  }

 private:
  std::vector<double> time_, energy_, lost_, given_, left_, right_;
  std::vector<std::uint64_t> contacts_, below_, merges_, bodies_;
};

/// The two heaviest clusters and the cloud, beside the series.
template <Real T> class CloudRecorder {
 public:
  void add(const Cloud<T>& cloud) {
    for (const auto* cluster : {&cloud.left, &cloud.right}) {
      mass_.push_back(*cluster ? to_double((*cluster)->mass) : none);
      x_.push_back(*cluster ? to_double((*cluster)->x) : none);
      v_.push_back(*cluster ? to_double((*cluster)->v) : none);
      index_.push_back(*cluster ? static_cast<std::uint64_t>((*cluster)->index) : no_body);
    }
    cloud_mass_.push_back(to_double(cloud.mass));
    cloud_width_.push_back(to_double(cloud.width));
  }

  /// Of the series, and the table below it, since they were called last.
  Columns take() { return columns(taken(cloud_mass_), taken(cloud_width_)); }
  Group take_heaviest() { return filled(heaviest_table(), taken(mass_), taken(x_), taken(v_), taken(index_)); }

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::uint64_t no_body = std::numeric_limits<std::uint64_t>::max();
  std::vector<double> mass_, x_, v_, cloud_mass_, cloud_width_;
  std::vector<std::uint64_t> index_;
};

/// The dense core, and the sticky gas that a shock is compared with, beside the series.
template <Real T> class CoreRecorder {
 public:
  CoreRecorder(std::shared_ptr<const cradle::Bodies<T>> bodies, const T& start)
      : bodies_(std::move(bodies)), start_(start) {}

  void add(const Configuration<T>& c, const T& energy) {
    const DenseCore core = dense_core(c);
    mass_.push_back(core.mass);
    width_.push_back(core.width);
    window_.push_back(core.window);
    gap_.push_back(core.gap);
    StickyGas<T> sticky(bodies_, start_);  // anew: what it gives must not depend on when it was looked at before
    sticky.advance(c.time);
    excess_.push_back(to_double(T(energy - (bodies_->kinetic_energy() - sticky.energy_lost()))));
  }
  Columns take() { return columns(taken(mass_), taken(width_), taken(window_), taken(gap_), taken(excess_)); }

 private:
  std::shared_ptr<const cradle::Bodies<T>> bodies_;
  T start_;
  std::vector<double> mass_, width_, window_, gap_, excess_;
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

template <Real T> std::vector<double> as_doubles(const std::vector<T>& values) {
  std::vector<double> doubles;
  doubles.reserve(values.size());
  for (const T& value : values) doubles.push_back(to_double(value));
  return doubles;
}

/// All active bodies at a time.
template <Real T> Group snapshot_table(const Configuration<T>& c, const std::string& name) {
  std::vector<std::uint64_t> index(c.index.begin(), c.index.end());
  Group table = filled(snapshot_table(name), as_doubles(c.x), as_doubles(c.v), as_doubles(c.m), std::move(index),
                       as_doubles(c.gap), as_doubles(c.closing_speed));
  table.attributes = {{"time", to_double(c.time)}};
  if (c.x.size() < 2) return table;
  const GapStatistics<T> gaps = gap_statistics(c);
  table.attributes.emplace_back("gap_min", to_double(gaps.least));
  table.attributes.emplace_back("gap_median", to_double(gaps.median));
  if (c.closure_gap) table.attributes.emplace_back("closure_gap", to_double(*c.closure_gap));
  if (c.closure_speed) table.attributes.emplace_back("closure_speed", to_double(*c.closure_speed));
  return table;
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
    high_.push_back(to_double(time));
    low_.push_back(to_double(difference(c.time, Pair<T>{T(rounded(time)), T(0)})));
    interval_.push_back(to_double(c.interval));
    speed_.push_back(to_double(c.closing_speed));
  }

  std::size_t rows() const { return left_.size(); }
  /// The rows since it was called last.
  Group take() {
    return filled(events_table(), taken(left_), taken(right_), taken(high_), taken(low_), taken(interval_),
                  taken(speed_));
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
  std::vector<double> high_, low_, interval_, speed_;
};

}  // namespace cradle::tools
