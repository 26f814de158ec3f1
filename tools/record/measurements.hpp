// The list of measurements, and those that a run holds. To add one, write its file and add it here.
#pragma once

#include <concepts>
#include <optional>
#include <tuple>
#include <utility>

#include "cradle/tools/record/averages.hpp"
#include "cradle/tools/record/correlations.hpp"
#include "cradle/tools/record/events.hpp"
#include "cradle/tools/record/histograms.hpp"
#include "cradle/tools/record/masses.hpp"
#include "cradle/tools/record/pair_distribution.hpp"
#include "cradle/tools/record/profiles.hpp"
#include "cradle/tools/record/scenario.hpp"
#include "cradle/tools/record/series.hpp"
#include "cradle/tools/record/snapshots.hpp"
#include "cradle/tools/record/structure.hpp"
#include "cradle/tools/record/word.hpp"
#include "cradle/tools/record/zone.hpp"

namespace cradle::tools {

template <class... Each> struct MeasurementList {};
template <Real T>
using AllMeasurements =
    MeasurementList<SeriesMeasurement<T>, SnapshotMeasurement, ProfileMeasurement, MassMeasurement, ZoneMeasurement,
                    AverageMeasurement, HistogramMeasurement<T>, CorrelationMeasurement<T>, StructureMeasurement,
                    PairMeasurement, ScenarioMeasurement, EventMeasurement<T>, WordMeasurement>;

/// Those that a scene wants.
template <Real T, class List = AllMeasurements<T>> class Measurements;
template <Real T, class... Each> class Measurements<T, MeasurementList<Each...>> {
 public:
  Measurements(const Scene& scene, const cradle::Particles<T>& particles, const Schedule<T>& plan)
      : scene_(scene), plan_(plan) {
    with_rows(all_, [&]<class M>(std::optional<M>& measurement, std::size_t row) {
      const Measured of{scene, particles.count(), plan.of[row].samples.size()};
      if (!M::row.wanted(scene)) return;
      if constexpr (std::constructible_from<M, const Measured&>)
        measurement.emplace(of);
      else
        measurement.emplace(of, particles);
    });
  }

  /// Whether any is due that needs all particles.
  bool need_particles(const T& time) const {
    return any([&](const auto& m, std::size_t row) { return m.row.of_particles && plan_.due(row, time); });
  }
  void find(const MomentIn<T>& now, const Stopped& stopped) {
    each([&](auto& m, std::size_t row) {
      if constexpr (requires { m.finder(); }) {
        if (plan_.due(row, now.time.value)) m.finder().find(now.configuration(), now.particles(), now.elapsed, stopped);
      } else if constexpr (requires { m.find(now, stopped); }) {
        if (plan_.due(row, now.time.value)) m.find(now, stopped);
      }
    });
  }
  void record(const MomentIn<T>& now, TableSink& put) {
    each([&](auto& m, std::size_t row) {
      if constexpr (requires(const Due& due) { m.record(now, due, put); })
        if (const Due due = plan_.due(row, now.time.value)) m.record(now, due, put);
    });
  }
  void record_last(const MomentIn<T>& now, TableSink& put) {
    each([&](auto& m, std::size_t) {
      if constexpr (requires { m.record_last(now, put); }) m.record_last(now, put);
    });
  }

  /// Calls f(observer) for each that observes collisions; `counts` are those of the engine.
  template <class F> void observe(const Counts& counts, TableSink& put, F f) {
    each([&](auto& m, std::size_t) {
      if constexpr (requires { &std::remove_reference_t<decltype(m)>::collision; }) {
        if (m.row.observes && !m.row.observes(scene_)) return;
        f([&m, &counts, &put](const Collision<T>& c) {
          made(m, counts);
          if constexpr (requires { m.put_rows(put); })
            if (m.rows() >= most_rows) m.put_rows(put);
          if constexpr (requires { m.collision(c); })
            m.collision(c);
          else
            m.collision(c.left, c.right, to_double(T(c.time.value())));
        });
      }
    });
  }
  bool many_rows() const {
    return any([](const auto& m, std::size_t) {
      if constexpr (requires { m.rows(); }) return m.rows() >= most_rows;
      return false;
    });
  }
  void put_rows(const Counts& counts, TableSink& put) {
    each([&](auto& m, std::size_t) {
      made(m, counts);
      if constexpr (requires { m.put_rows(put); }) m.put_rows(put);
    });
  }
  Summary finish(const MomentIn<T>& now, TableSink& put) {
    Summary summary;
    each([&](auto& m, std::size_t) {
      if constexpr (requires { m.finish(now, put); }) m.finish(now, put);
      if constexpr (requires { m.summary(); }) append(summary, m.summary());
    });
    return summary;
  }

  static auto state(auto& self) {
    return std::apply([](auto&... m) { return std::tie(m...); }, self.all_);
  }
  void loaded() const {
    with_rows(all_, [&]<class M>(const std::optional<M>& measurement, std::size_t) {
      require_state(measurement.has_value() == M::row.wanted(scene_), "measurements");
    });
  }

 private:
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
  bool any(const auto& f) const {
    bool found = false;
    with_rows(all_, [&](const auto& m, std::size_t row) { found = found || (m && f(*m, row)); });
    return found;
  }

  const Scene& scene_;
  const Schedule<T>& plan_;
  std::tuple<std::optional<Each>...> all_;
};

}  // namespace cradle::tools
