// The measurements that a run holds; at the end the list of all. To add one, write its file, include it and list it.
#pragma once

#include <array>
#include <optional>
#include <tuple>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/record/averages.hpp"
#include "cradle/tools/record/correlations.hpp"
#include "cradle/tools/record/events.hpp"
#include "cradle/tools/record/histograms.hpp"
#include "cradle/tools/record/masses.hpp"
#include "cradle/tools/record/places.hpp"
#include "cradle/tools/record/profiles.hpp"
#include "cradle/tools/record/scenario.hpp"
#include "cradle/tools/record/series.hpp"
#include "cradle/tools/record/snapshots.hpp"
#include "cradle/tools/record/word.hpp"
#include "cradle/tools/record/zone.hpp"

namespace cradle::tools {

/// Those that a scene wants.
template <class... Each> class MeasurementsOf {
 public:
  static constexpr std::array rows{&Each::row...};

  MeasurementsOf(const Scene& scene, AnyEngine& engine, const Schedule& plan, bool exact)
      : scene_(scene), engine_(engine), plan_(plan), exact_(exact) {
    with_rows(all_, [&]<class M>(std::optional<M>& measurement, std::size_t row) {
      if (M::row.wanted(scene)) measurement.emplace(measured(row));
    });
  }
  /// As just made, for an engine that begins again.
  void begin_again() {
    with_rows(all_, [&]<class M>(std::optional<M>& measurement, std::size_t row) {
      if constexpr (requires { measurement->begin_again(); })
        measurement->begin_again();
      else if (measurement)
        measurement.emplace(measured(row));
    });
  }

  /// Asks the plan what is due now, for `series_is_due`, `find` and `record`. Returns whether that needs all particles.
  bool come_to(const Number& time) {
    bool need_particles = false;
    each([&](auto& m, std::size_t row) {
      due_[row] = plan_.due(row, time);
      need_particles = need_particles || (m.row.of_particles && due_[row]);
    });
    return need_particles;
  }
  bool series_is_due() const { return due_.front().sample; }
  void find(const RunState& now, const Stopped& stopped) {
    each([&](auto& m, std::size_t row) {
      if constexpr (requires { m.find(now, stopped); })
        if (due_[row]) m.find(now, stopped);
    });
  }
  void record(const RunState& now, TableSink& put) {
    each([&](auto& m, std::size_t row) {
      if constexpr (requires { m.record(now, due_[row], put); })
        if (due_[row]) m.record(now, due_[row], put);
    });
  }
  void record_last(const RunState& now, TableSink& put) {
    each([&](auto& m, std::size_t) {
      if constexpr (requires { m.record_last(now, put); }) m.record_last(now, put);
    });
  }

  /// Calls f(observer) for each that observes collisions; `counts` are those of the engine.
  template <class F> void observe(const Counts& counts, TableSink& put, F f) {
    each([&](auto& m, std::size_t) {
      if constexpr (requires { &std::remove_reference_t<decltype(m)>::collision; }) {
        f([&m, &counts, &put](const ObservedCollision& c) {
          made(m, counts);
          if constexpr (requires { m.put_rows(put); })
            if (m.rows() >= most_rows) m.put_rows(put);
          m.collision(c);
        });
      }
    });
  }
  bool many_rows() const {
    bool many = false;
    with_rows(all_, [&](const auto& m, std::size_t) {
      if constexpr (requires { m->rows(); }) many = many || (m && m->rows() >= most_rows);
    });
    return many;
  }
  void put_rows(const Counts& counts, TableSink& put) {
    each([&](auto& m, std::size_t) {
      made(m, counts);
      if constexpr (requires { m.put_rows(put); }) m.put_rows(put);
    });
  }
  Summary finish(const RunState& now, TableSink& put) {
    Summary summary;
    each([&](auto& m, std::size_t) {
      if constexpr (requires { m.finish(now, put); }) m.finish(now, put);
      if constexpr (requires { m.summary(); }) append(summary, m.summary());
    });
    return summary;
  }

  static auto state(auto& self) {
    return std::apply([](auto&... m) { return fields(m...); }, self.all_);
  }
  void loaded() const {
    with_rows(all_, [&]<class M>(const std::optional<M>& measurement, std::size_t) {
      require_state(measurement.has_value() == M::row.wanted(scene_), "measurements");
    });
  }

 private:
  Measured measured(std::size_t row) const { return {scene_, engine_, plan_.of[row].samples.size(), exact_}; }

  static constexpr std::size_t most_rows = 1 << 14;  // that wait for the sink

  static void made(auto& m, const Counts& counts) {
    if constexpr (requires { m.made(counts); }) m.made(counts);
  }
  static void with_rows(auto& all, const auto& f) {
    std::size_t row = 0;
    std::apply([&](auto&... m) { (f(m, row++), ...); }, all);
  }
  void each(const auto& f) {
    with_rows(all_, [&](auto& m, std::size_t row) { m ? f(*m, row) : void(); });
  }

  const Scene& scene_;
  AnyEngine& engine_;
  const Schedule& plan_;
  bool exact_;
  std::tuple<std::optional<Each>...> all_;
  std::array<Due, sizeof...(Each)> due_ = {};  // at the time that the run has come to
};

/// All of them, in the order of their tables; the series is first (series_is_due).
using Measurements =
    MeasurementsOf<SeriesMeasurement, SnapshotMeasurement, ProfileMeasurement, MassMeasurement, ZoneMeasurement,
                   AverageMeasurement, HistogramMeasurement, CorrelationMeasurement, StructureMeasurement,
                   PairMeasurement, ScenarioMeasurement, EventMeasurement, WordMeasurement>;

}  // namespace cradle::tools
