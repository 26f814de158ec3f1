// Every collision, and the initial state of the particles that have collided.
#pragma once

#include <algorithm>

#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

template <Real T> class EventMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "events",
      .at_end = "initial",
      .wanted = [](const Scene& scene) { return scene.output.events; },
      .leave_out = [](Output& output) { output.events = false; },
      .averaged = false,
  };

  explicit EventMeasurement(const Measured&) {}

  void collision(const Collision<T>& c) {
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
  /// The kind of the last collision follows from the counts after it.
  void made(const Counts& now) {
    if (rows_ > 0) kind_[rows_ - 1] = now.merges > merges_ ? 2 : now.below_cutoff > below_cutoff_ ? 1 : 0;
    merges_ = now.merges, below_cutoff_ = now.below_cutoff;
  }

  static auto state(auto&) { return std::tie(); }

  std::size_t rows() const { return rows_; }
  void put_rows(TableSink& put) {
    if (rows_ > 0) put.add(taken_rows());
  }
  void finish(const MomentIn<T>& now, TableSink& put) {
    put.add(taken_rows());  // the table is there even without a collision
    const Configuration<T> end = now.after_last_collision();
    put.add(initial_rows(now.particles(), end.from, end.to));
  }

 private:
  Recorded<T> taken_rows() {
    resize(std::exchange(rows_, 0));
    return {{"events",
             {},
             {{"left", "1", "number of the left particle at the start", {}},
              {"right", "1", "number of the right particle at the start", {}},
              {"time", "t", "time of the collision, rounded", {}},
              {"time_low", "t", "what time misses: the collision is at time + time_low", {}},
              {"interval", "t", "time since the collision before", {}},
              {"closing_speed", "l/t", "closing speed before the collision", {}},
              {"kind", "1", "0 by the law, 1 below the cut-off or within the contact time, 2 merged", {}, 1, true}}},
            columns<T>(taken(left_), taken(right_), taken(time_), taken(low_), taken(interval_), taken(speed_),
                       taken(kind_)),
            {}};
  }

  static Recorded<T> initial_rows(const cradle::Particles<T>& particles, ParticleIndex first, ParticleIndex last) {
    std::vector<std::uint64_t> index;
    std::vector<T> x, v, m, gap;
    for (ParticleIndex particle = first; particle <= last; ++particle) {
      index.push_back(static_cast<std::uint64_t>(particle));
      x.push_back(particles.position(particle));
      v.push_back(particles.velocity(particle));
      m.push_back(particles.mass(particle));
      gap.push_back(particle + 1 < particles.count() || particles.on_ring() ? particles.gap(particle) : none<T>());
    }
    return {{"initial",
             {},
             {{"index", "1", "number of the particle, from the left", {}},
              {"x", "l", "position at the start", {}},
              {"v", "l/t", "velocity at the start", {}},
              {"m", "m", "mass", {}},
              {"gap",
               "l",
               "distance to the next particle: resolves what x cannot; nan behind the last one of a line",
               {}}}},
            columns<T>(std::move(index), std::move(x), std::move(v), std::move(m), std::move(gap)),
            {{"circumference", particles.circumference()}}};
  }

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
