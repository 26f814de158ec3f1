// Collects samples, configurations, profiles and collisions during a run, and puts them into the tables of a result
// file (tables.hpp).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/engine/status.hpp"
#include "cradle/core/observe/clusters.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/record/tables.hpp"

namespace cradle::tools {

/// The two heaviest clusters: the table series/heaviest.
template <Real T> class HeaviestRecorder {
 public:
  void add(const Cloud<T>& cloud) {
    for (const auto* cluster : {&cloud.left, &cloud.right}) {
      mass_.push_back(*cluster ? (*cluster)->mass : none<T>());
      x_.push_back(*cluster ? (*cluster)->x : none<T>());
      v_.push_back(*cluster ? (*cluster)->v : none<T>());
      index_.push_back(*cluster ? static_cast<std::uint64_t>((*cluster)->index) : no_particle);
    }
  }

  /// The rows since the last call.
  Recorded<T> take() { return {heaviest_table(), columns<T>(taken(mass_), taken(x_), taken(v_), taken(index_)), {}}; }

 private:
  static constexpr std::uint64_t no_particle = std::numeric_limits<std::uint64_t>::max();
  std::vector<T> mass_, x_, v_;
  std::vector<std::uint64_t> index_;
};

/// The number of clusters of each mass.
template <Real T>
Group masses_table(const Configuration<T>& c, double time, const T& least_mass, const std::string& name) {
  std::vector<std::uint64_t> clusters = mass_distribution(c, least_mass);
  std::vector<double> from;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    from.push_back(to_double(least_mass) * std::exp2(static_cast<double>(k) / 4));
  Group table = filled(masses_table(name), std::move(from), std::move(clusters));
  table.attributes = {{"time", time}};
  return table;
}

/// All active particles at a time.
template <Real T> Recorded<T> snapshot_rows(const Configuration<T>& c, const Given<T>& time, const std::string& name) {
  std::vector<std::uint64_t> index(c.index.begin(), c.index.end());
  Recorded<T> rows{
      snapshot_table(name), columns<T>(c.x, c.v, c.m, std::move(index), c.gap, c.closing_speed), {{"time", time}}};
  if (c.x.size() < 2) return rows;
  const GapStatistics<T> gaps = gap_statistics(c);
  rows.attributes.emplace_back("gap_min", gaps.least);
  rows.attributes.emplace_back("gap_median", gaps.median);
  if (c.closure_gap) rows.attributes.emplace_back("closure_gap", *c.closure_gap);
  if (c.closure_speed) rows.attributes.emplace_back("closure_speed", *c.closure_speed);
  return rows;
}

/// The initial state of particles `first` to `last`.
template <Real T>
Recorded<T> initial_rows(const cradle::Particles<T>& particles, ParticleIndex first, ParticleIndex last) {
  std::vector<std::uint64_t> index;
  std::vector<T> x, v, m, gap;
  for (ParticleIndex particle = first; particle <= last; ++particle) {
    index.push_back(static_cast<std::uint64_t>(particle));
    x.push_back(particles.position(particle));
    v.push_back(particles.velocity(particle));
    m.push_back(particles.mass(particle));
    gap.push_back(particle + 1 < particles.count() || particles.on_ring() ? particles.gap(particle) : none<T>());
  }
  return {initial_table(),
          columns<T>(std::move(index), std::move(x), std::move(v), std::move(m), std::move(gap)),
          {{"circumference", particles.circumference()}}};
}

inline Group profile_table(Profile&& p, const std::string& name) {
  Group table = filled(profile_table(name), std::move(p.x), std::move(p.velocity), std::move(p.density),
                       std::move(p.mass_density), std::move(p.temperature), std::move(p.density_right),
                       std::move(p.velocity_right), std::move(p.density_left), std::move(p.velocity_left));
  table.attributes = {{"time", p.time}};
  return table;
}

/// Every collision, if the scene requests it.
template <Real T> class EventRecorder {
 public:
  void operator()(const Collision<T>& c) {
    // Room for many at once: a test for each column would take longer than all else here.
    if (rows_ == left_.size()) resize(std::max<std::size_t>(2 * rows_, 1 << 10));
    left_[rows_] = static_cast<std::uint64_t>(c.left);
    right_[rows_] = static_cast<std::uint64_t>(c.right);
    const T time = c.time.value();
    time_[rows_] = time;
    low_[rows_] = to_double(difference(c.time, Pair<T>{T(rounded(time)), T(0)}));
    interval_[rows_] = c.interval;
    speed_[rows_] = c.closing_speed;
    ++rows_;
  }
  /// Records the kind of the last collision, from the engine's counts after it. Call it before the next collision.
  void made(const Counts& now) {
    if (rows_ > 0) kind_[rows_ - 1] = now.merges > merges_ ? 2 : now.below_cutoff > below_cutoff_ ? 1 : 0;
    merges_ = now.merges, below_cutoff_ = now.below_cutoff;
  }

  std::size_t rows() const { return rows_; }
  /// The rows since the last call.
  Recorded<T> take() {
    resize(std::exchange(rows_, 0));
    return {events_table(),
            columns<T>(taken(left_), taken(right_), taken(time_), taken(low_), taken(interval_), taken(speed_),
                       taken(kind_)),
            {}};
  }

 private:
  // The number of type T for the double nearest to `time`.
  static T rounded(const T& time) {
    if constexpr (std::same_as<T, double>)
      return time;
    else
      return T(to_double(time));
  }

  void resize(std::size_t rows) {
    for (auto* column : {&left_, &right_, &kind_}) column->resize(rows);
    for (auto* column : {&time_, &interval_, &speed_}) column->resize(rows);
    low_.resize(rows);
  }

  std::size_t rows_ = 0;
  std::vector<std::uint64_t> left_, right_, kind_;
  std::uint64_t merges_ = 0, below_cutoff_ = 0;  // before the last collision
  std::vector<T> time_, interval_, speed_;
  std::vector<double> low_;
};

}  // namespace cradle::tools
