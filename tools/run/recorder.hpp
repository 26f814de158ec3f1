// What a run leaves behind: collects samples, configurations, profiles and contacts while it goes on, and lays them out
// as the tables of a result file.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tools/result/result.hpp"

namespace cradle::tools {

/// The time series. Numbers are rounded to float64 here, at the last moment.
template <Real T> class SeriesRecorder {
 public:
  void add(const Sample<T>& s) {
    time_.push_back(to_double(s.time));
    energy_.push_back(to_double(s.energy));
    lost_.push_back(to_double(s.energy_lost));
    contacts_.push_back(s.counts.contacts);
    below_.push_back(s.counts.below_cutoff);
    merges_.push_back(s.counts.merges);
    bodies_.push_back(static_cast<std::uint64_t>(s.bodies));
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    left_.push_back(s.front_left ? to_double(*s.front_left) : none);
    right_.push_back(s.front_right ? to_double(*s.front_right) : none);
  }
  bool empty() const { return time_.empty(); }
  double last_time() const { return time_.back(); }

  Group table() && {
    return {"series",
            {},
            {{"time", "t", "a sample is the state after all contacts at times <= t", std::move(time_)},
             {"energy", "m l^2/t^2", "kinetic energy of all bodies of the scene", std::move(energy_)},
             {"energy_lost", "m l^2/t^2", "energy lost in contacts since the start", std::move(lost_)},
             {"contacts", "1", "contacts since the start, those below the cut-off and merges included",
              std::move(contacts_)},
             {"contacts_below_cutoff", "1", "contacts closing slower than the cut-off", std::move(below_)},
             {"merges", "1", "merges since the start", std::move(merges_)},
             {"bodies", "1", "bodies in the active zone, between the outermost that have collided", std::move(bodies_)},
             {"front_left", "l", "position of the leftmost body that has collided", std::move(left_)},
             {"front_right", "l", "position of the rightmost body that has collided", std::move(right_)}}};
  }

 private:
  std::vector<double> time_, energy_, lost_, left_, right_;
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

  /// Adds what belongs to the series itself and returns the group below it.
  Group table(Group& series) && {
    series.columns.push_back({"cloud_mass", "m", "mass of all bodies that have collided", std::move(cloud_mass_)});
    series.columns.push_back({"cloud_width", "l",
                              "standard deviation of position, weighted by mass, of all that have collided but the "
                              "two heaviest clusters",
                              std::move(cloud_width_)});
    return {"series/heaviest",
            {},
            {{"mass", "m", "of the two heaviest clusters, the left and the right one", std::move(mass_), 2},
             {"x", "l", "their positions", std::move(x_), 2},
             {"v", "l/t", "their velocities", std::move(v_), 2},
             {"index", "1", "number at the start of the body they go by, the same after passing", std::move(index_), 2,
              true}}};
  }

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  static constexpr std::uint64_t no_body = std::numeric_limits<std::uint64_t>::max();
  std::vector<double> mass_, x_, v_, cloud_mass_, cloud_width_;
  std::vector<std::uint64_t> index_;
};

/// How many clusters there are of which mass.
template <Real T> Group masses_table(const Configuration<T>& c, const T& least_mass, const std::string& name) {
  std::vector<std::uint64_t> clusters = mass_distribution(c, least_mass);
  std::vector<double> from;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    from.push_back(to_double(least_mass) * std::exp2(static_cast<double>(k) / 4));
  return {name,
          {{"time", to_double(c.time)}},
          {{"mass", "m", "least mass of the bin, which ends where the next one begins: 2^(1/4) times as high",
            std::move(from)},
           {"clusters", "1", "clusters of such a mass", std::move(clusters)}}};
}

inline Group zone_table(const ZoneAverage& zone, const ZoneWidth& width, std::size_t bins, double from, double until) {
  Group group{"zone",
              {{"from", from},
               {"until", until},
               {"samples", static_cast<std::uint64_t>(zone.samples())},
               {"width", width.width},
               {"width_error", width.error}},
              {}};
  std::vector<double> x;
  for (std::size_t bin = 0; bin < bins; ++bin) x.push_back(zone.centre(bin));
  group.columns = {{"x", "l", "centre of the bin", std::move(x)},
                   {"mass_density", "m/l", "mass per length", zone.mass_density()},
                   {"density_right", "1/l", "right-moving single bodies per length", zone.density_right()},
                   {"velocity_right", "l/t", "their mean velocity", zone.velocity_right()},
                   {"density_left", "1/l", "left-moving single bodies per length", zone.density_left()},
                   {"velocity_left", "l/t", "their mean velocity", zone.velocity_left()}};
  return group;
}

inline std::vector<std::pair<std::string, double>> scenario_numbers(const Scenario& s) {
  const bool met = s.passes + s.sticks > 0;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {{"pair_established", s.established},
          {"first_meeting", s.first_meeting},
          {"first_passed", met ? double(s.first_passed) : none},
          {"passes", static_cast<double>(s.passes)},
          {"sticks", static_cast<double>(s.sticks)},
          {"role_changes", static_cast<double>(s.role_changes)},
          {"regime", static_cast<double>(s.regime)},
          {"separation_exponent", s.separation_exponent},
          {"speed_exponent", s.speed_exponent}};
}

template <Real T> std::vector<double> as_doubles(const std::vector<T>& values) {
  std::vector<double> doubles;
  doubles.reserve(values.size());
  for (const T& value : values) doubles.push_back(to_double(value));
  return doubles;
}

template <Real T> Group snapshot_table(const Configuration<T>& c, const std::string& name) {
  Group group{name, {{"time", to_double(c.time)}}, {}};
  if (c.x.size() > 1) {
    const GapStatistics<T> gaps = gap_statistics(c);
    group.attributes.emplace_back("gap_min", to_double(gaps.least));
    group.attributes.emplace_back("gap_median", to_double(gaps.median));
    if (c.closure_gap) group.attributes.emplace_back("closure_gap", to_double(*c.closure_gap));
    if (c.closure_speed) group.attributes.emplace_back("closure_speed", to_double(*c.closure_speed));
  }
  std::vector<std::uint64_t> index(c.index.begin(), c.index.end());
  group.columns = {{"x", "l", "position", as_doubles(c.x)},
                   {"v", "l/t", "velocity", as_doubles(c.v)},
                   {"m", "m", "mass", as_doubles(c.m)},
                   {"index", "1", "number of the body at the start, from the left", std::move(index)},
                   {"gap", "l", "distance to the next body: resolves what x cannot", as_doubles(c.gap)},
                   {"closing_speed", "l/t", "velocity minus that of the next body", as_doubles(c.closing_speed)}};
  return group;
}

inline Group profile_table(Profile&& p, const std::string& name) {
  return {name,
          {{"time", p.time}},
          {{"x", "l", "centre of the bin", std::move(p.x)},
           {"velocity", "l/t", "mass-weighted mean velocity", std::move(p.velocity)},
           {"density", "1/l", "bodies per length", std::move(p.density)},
           {"mass_density", "m/l", "mass per length", std::move(p.mass_density)},
           {"temperature", "l^2/t^2", "mass-weighted variance of velocity", std::move(p.temperature)},
           {"density_right", "1/l", "right-moving bodies per length", std::move(p.density_right)},
           {"velocity_right", "l/t", "mean velocity of right-movers", std::move(p.velocity_right)},
           {"density_left", "1/l", "left-moving bodies per length", std::move(p.density_left)},
           {"velocity_left", "l/t", "mean velocity of left-movers", std::move(p.velocity_left)}}};
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

  Group table() && {
    return {"events",
            {},
            {{"left", "1", "number of the left body at the start", std::move(left_)},
             {"right", "1", "number of the right body at the start", std::move(right_)},
             {"time", "t", "time of the contact, rounded", std::move(high_)},
             {"time_low", "t", "what time misses: the contact is at time + time_low", std::move(low_)},
             {"interval", "t", "time since the contact before", std::move(interval_)},
             {"closing_speed", "l/t", "closing speed before the contact", std::move(speed_)}}};
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
