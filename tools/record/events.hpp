// Every collision, and the initial state of the particles that have collided.
#pragma once

#include <algorithm>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/record/measurement.hpp"

namespace cradle::tools {

class EventMeasurement {
 public:
  static constexpr MeasurementRow row{
      .name = "events",
      .at_end = "initial",
      .wanted = [](const Scene& scene) { return scene.output.events; },
      .leave_out = [](Output& output) { output.events = false; },
      .averaged = false,
  };

  explicit EventMeasurement(const Measured& of) : exact_(of.exact) {}

  void collision(const ObservedCollision& c) {
    // Room for many at once: a test for each column would take longer than all else here.
    if (rows_ == left_.size()) resize(std::max<std::size_t>(2 * rows_, 1 << 10));
    left_[rows_] = static_cast<std::uint64_t>(c.left);
    right_[rows_] = static_cast<std::uint64_t>(c.right);
    time_.values[rows_] = c.time;
    low_[rows_] = c.time_low();
    interval_.values[rows_] = c.interval;
    speed_.values[rows_] = c.closing_speed;
    ++rows_;
    if (!exact_) return;
    ObservedCollision::Texts texts = c.texts();
    time_.texts->push_back(std::move(texts.time));
    interval_.texts->push_back(std::move(texts.interval));
    speed_.texts->push_back(std::move(texts.closing_speed));
  }
  /// The kind of the last collision follows from the counts after it.
  void made(const Counts& now) {
    if (rows_ > 0) kind_[rows_ - 1] = now.merges > merges_ ? 2 : now.below_cutoff > below_cutoff_ ? 1 : 0;
    merges_ = now.merges, below_cutoff_ = now.below_cutoff;
  }

  static auto state(auto&) { return fields(); }

  std::size_t rows() const { return rows_; }
  void put_rows(TableSink& put) {
    if (rows_ > 0) put.add(taken_rows());
  }
  void finish(const RunState& now, TableSink& put) {
    put.add(taken_rows());  // the table is there even without a collision
    put.add(initial_rows(now));
  }

 private:
  Recorded taken_rows() {
    resize(std::exchange(rows_, 0));
    return {
        {"events",
         {},
         {{"left", "1", "number of the left particle at the start", {}},
          {"right", "1", "number of the right particle at the start", {}},
          {"time", "t", "time of the collision, rounded", {}},
          {"time_low", "t", "what time misses: the collision is at time + time_low", {}},
          {"interval", "t", "time since the collision before", {}},
          {"closing_speed", "l/t", "closing speed before the collision", {}},
          {"kind", "1", "0 by the law, 1 below the cut-off or within the contact time, 2 merged", {}, 1, true}}},
        columns(taken(left_), taken(right_), taken(time_), taken(low_), taken(interval_), taken(speed_), taken(kind_)),
        {}};
  }

  Recorded initial_rows(const RunState& now) const {
    const auto [first, last] = now.after_last_collision()->range();
    std::vector<std::uint64_t> index;
    for (ParticleIndex particle = first; particle <= last; ++particle)
      index.push_back(static_cast<std::uint64_t>(particle));
    const auto column = [&, first = first, last = last](RunState::Column which) {
      NumberColumn numbers(exact_);
      for (const Number& x : now.at_start(which, first, last)) numbers.push_back(x);
      return numbers;
    };
    using enum RunState::Column;
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
            columns(std::move(index), column(x), column(v), column(m), column(gap)),
            {{"circumference", now.circumference()}}};
  }

  void resize(std::size_t rows) {
    for (auto* column : {&left_, &right_, &kind_}) column->resize(rows);
    for (auto* column : {&time_, &interval_, &speed_}) column->values.resize(rows);
    low_.resize(rows);
  }

  std::size_t rows_ = 0;
  std::vector<std::uint64_t> left_, right_, kind_;
  std::uint64_t merges_ = 0, below_cutoff_ = 0;  // before the last collision
  bool exact_;
  NumberColumn time_{exact_}, interval_{exact_}, speed_{exact_};
  std::vector<double> low_;
};

}  // namespace cradle::tools
