// A `Schedule` has the times at which a run is sampled: those of the series, of the snapshots and of the other outputs
// of a scene, and all of them together, in the working precision.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/record/rows.hpp"

namespace cradle::tools {

/// Increasing times, each with the decimal that it stands for. Of several times that the type cannot distinguish, only
/// the first is kept.
class Times {
 public:
  Times() = default;
  template <class Decimals> Times(const Decimals& decimals, Rounding round) {
    for (std::size_t k = 0; k < decimals.size(); ++k) push_back(text_of(decimals[k]), round);
  }
  void push_back(std::string_view decimal, Rounding round);

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  Number operator[](std::size_t k) const { return exact_.empty() ? Number{values_[k], nullptr} : exact_[k]; }
  Number back() const { return (*this)[size() - 1]; }
  /// The index of the first time that is not before `time` (first_from), or of the first one that is after it
  /// (first_after).
  std::size_t first_from(const Number& time) const;
  std::size_t first_after(const Number& time) const {
    const std::size_t k = first_from(time);
    return k + (is_at(k, time) ? 1 : 0);
  }
  bool hold(const Number& time) const { return is_at(first_from(time), time); }
  std::vector<double> rounded() const;  // the decimals, as results store them
  std::optional<RunTime> find(const Number& time) const {
    const std::size_t k = first_from(time);
    return is_at(k, time) ? std::optional(RunTime(time, decimals_[k])) : std::nullopt;
  }
  /// The decimal of `time`, which must be one of these times.
  std::string_view decimal(const Number& time) const { return decimals_[first_from(time)]; }

 private:
  static std::string_view text_of(std::string_view decimal) { return decimal; }
  static std::string_view text_of(const Decimal& decimal) { return decimal.text; }

  bool is_at(std::size_t first, const Number& time) const { return first < size() && !(time < (*this)[first]); }

  std::vector<double> values_;
  std::vector<Number> exact_;  // none in double
  DecimalColumn decimals_;
};

/// When a measurement is due: the times of its samples, and those of its tables.
struct MeasurementTimes {
  Times samples, tables;
};
/// What of a measurement is due at one time.
struct Due {
  bool sample = false;
  std::optional<double> table;  // its time
  explicit operator bool() const { return sample || table; }
};

/// All times at which a run is recorded are made here.
class Schedule {
 public:
  /// Throws Error for a scalar type that this build does not have.
  explicit Schedule(const Scene& scene);
  Schedule& operator=(Schedule&&) = delete;

  std::vector<MeasurementTimes> of;  // as measurement_rows() has them

  const Times& series() const { return of[row_number("series")].samples; }
  const Times& snapshots() const { return of[row_number("snapshots")].tables; }
  Due due(std::size_t row, const Number& time) const;
  /// What a time of the run stands for: a decimal of the scene or, for the time of a collision, that time itself.
  RunTime meant(const Number& time) const;
  /// The first time after `after` at which the run is recorded; the first of all if `after` is empty.
  std::optional<Number> next(const std::optional<Number>& after) const;
  const Number& last() const { return last_; }
  /// The decimal times that this stop of a run stands for. Points between the ends of a series need not be decimals:
  /// they are the run's own times. `at_collision`: the run ends at this time, with its last collision.
  std::vector<RequestedTime> requested(const Scene& scene, const Number& time, bool at_collision) const;

 private:
  Times end_;
  std::vector<const Times*> all_;  // those that are not empty
  Number last_;
};

}  // namespace cradle::tools
