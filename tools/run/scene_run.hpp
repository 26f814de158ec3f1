// A run in progress. It advances the engine from one output time to the next and records the state there; at the end
// the records become tables and texts.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cradle/tools/record/columns.hpp"
#include "cradle/tools/record/correlations.hpp"
#include "cradle/tools/record/histograms.hpp"
#include "cradle/tools/record/recorder.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/record/word.hpp"
#include "cradle/tools/result/growing_tables.hpp"
#include "cradle/tools/engines/engine.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/run/run_sample.hpp"

namespace cradle::tools {

template <Real T> class SceneRun {
  static constexpr std::size_t most_rows = 1 << 14;  // rows that wait for the store

 public:
  SceneRun(const Scene& scene, std::shared_ptr<const cradle::Particles<T>> particles, Engine<T>& engine,
           const RunOptions& options, Progress& progress)
      : scene_(scene), options_(options), particles_(std::move(particles)), energy_(particles_->kinetic_energy()),
        engine_(engine), progress_(progress), plan_(schedule<T>(scene)), series_(scene),
        guards_(scene, *particles_, engine) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
    if (!plan_.averages.empty()) averages_.emplace(time_averages(scene, plan_.averages.size()));
    if (!scene.output.histograms.empty()) histograms_.emplace(scene, particles_->count());
    if (CorrelationRecorder<T>::wanted(scene.output)) correlations_.emplace(scene, *particles_, plan_);
    if (scene.output.word) word_.emplace(scene);
  }

  RunOutcome operator()() {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    observe();
    if (options_.store != nullptr && options_.store->loaded_from() != nullptr) load(*options_.store->loaded_from());
    const Status status = pass(plan_.stops.back(), [this](const T& time) { return advance(time); });
    const T end = status == Status::reached ? plan_.stops.back() : engine_.last_collision_time();
    if (options_.store != nullptr && (status == Status::reached || status == Status::interrupted))
      keep(end, status == Status::reached ? RunIs::over : RunIs::interrupted);
    return end_with(status);
  }

  // ---- the same in parts, for a run that is held (live_run.hpp)

  /// Composes what observes collisions; `first` comes before what records them, so that nothing of a collision is
  /// recorded if it throws.
  void observe(const Observer<T>& first = {}) {
    observer_ = first;
    const auto also = [this](const Observer<T>& added) {
      observer_ = observer_ ? [before = observer_, added](const Collision<T>& c) { before(c), added(c); } : added;
    };
    if (scene_.output.events) also([this](const Collision<T>& c) { record_collision(c); });
    if (word_) also([this](const Collision<T>& c) { word_->add(c.left, to_double(T(c.time.value()))); });
    if (histograms_ && scene_.output.observes_collisions())
      also([this](const Collision<T>& c) { histograms_->made(engine_.counts()), (*histograms_)(c); });
    if (scene_.output.scenario)
      also([this](const Collision<T>& c) {
        scenario_.collision(c.left, c.right, to_double(T(c.time.value())), engine_.counts().merges);
      });
    if (options_.observer != nullptr)
      also([this](const Collision<T>& c) {
        options_.observer->collision(c.left, c.right, to_double(T(c.time.value())));
      });
  }
  const Observer<T>& observer() const { return observer_; }

  /// Records at every output time up to `until`. `advance(time)` makes the collisions up to a time.
  template <class Advance> Status pass(const T& until, const Advance& advance) {
    for (;;) {
      const auto& stops = plan_.stops;
      const auto next = inspected_ ? std::upper_bound(stops.begin(), stops.end(), *inspected_) : stops.begin();
      const bool stop = next != stops.end() && !(until < *next);
      if (!stop && inspected_ && !(*inspected_ < until)) return Status::reached;
      const Status status = advance(stop ? *next : until);
      if (status != Status::reached || !stop) return status;
      if (!sample_at(*next)) return Status::interrupted;
      progress_.report(to_double(*next), engine_.counts().collisions);
    }
  }

  /// The outcome of a run that ends with this status.
  RunOutcome end_with(Status status) {
    const bool reached = status == Status::reached;
    const T end = reached ? plan_.stops.back() : engine_.last_collision_time();
    if (!reached && (status != Status::interrupted || options_.store == nullptr)) record_end(end);
    return finish(status, end);
  }

  T energy_at(const T& time) const { return energy_now(engine_, energy_, time); }

  /// Gives the rows recorded so far to the store.
  void put_rows() {
    if (histograms_) histograms_->made(engine_.counts());
    put(series_.take());
    if (has_clouds(scene_)) put(heaviest_.take());
    if (!scene_.output.events) return;
    events_.made(engine_.counts());
    put(events_.take());
  }
  /// Saves all else from which the run can continue.
  void save(StateSink& to) const {
    cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
    engine_.save(to);
    cradle::save(to, *this);
  }
  void load(StateSource& from) {
    try {
      std::pair<std::string, std::string> kind;
      cradle::load(from, kind);
      if (kind != std::pair(shape(), precision_name(scene_.run)))
        throw Error({}, "a checkpoint of another build or precision", "", "continue with the program that wrote it",
                    Exit::io);
      engine_.load(from);
      cradle::load(from, *this);
    } catch (const std::invalid_argument& error) {
      throw Error(std::string("the checkpoint cannot be extended: ") + error.what(), Exit::io);
    }
    from.end();
    const T last = engine_.last_collision_time();
    guards_.check_loaded(inspected_ && last < *inspected_ ? *inspected_ : last);
    progress_.continue_from(to_double(engine_.last_collision_time()), engine_.counts().collisions);
  }

  // What is saved besides the engine's state: how much of the plan is done, and what observers have collected.
  static auto state(auto& self) {
    return std::tie(self.inspected_, self.snapshots_, self.profiles_, self.masses_, self.zone_, self.scenario_,
                    self.averages_, self.histograms_, self.correlations_, self.word_, self.guards_);
  }

  void loaded() const {
    require_state(zone_.has_value() == scene_.output.zone.from.has_value(), "zone");
    require_state(averages_.has_value() == !plan_.averages.empty(), "averages");
    require_state(histograms_.has_value() == !scene_.output.histograms.empty(), "histograms");
    require_state(correlations_.has_value() == CorrelationRecorder<T>::wanted(scene_.output), "correlations");
    require_state(word_.has_value() == scene_.output.word.has_value(), "word");
  }

 private:
  // ---- what is stored during the run

  std::string shape() const { return engine_.shape() + state_shape<SceneRun>() + std::string(exact_part<T>); }

  // Gives the recorded rows to the store and, from time to time, the state.
  void keep(const T& time, RunIs run_is = RunIs::in_progress) {
    put_rows();
    RunStatus now = guards_.status();
    now.time = plan_.meant(time).rounded;
    now.collisions = engine_.counts().collisions;
    options_.store->keep(
        now, [this](StateSink& to) { save(to); }, run_is);
  }
  // Decimals are made only for a store: ensembles and proofs do not use them.
  void put(Recorded<T>&& rows) {
    for (Group& table : tables(std::move(rows), options_.store != nullptr)) put(std::move(table));
  }
  void put(Group&& rows) {
    if (options_.store != nullptr)
      options_.store->add(std::move(rows));
    else
      tables_.add(std::move(rows));
  }

  bool stopped() const { return options_.interrupt != nullptr && options_.interrupt->signal() != 0; }
  Status advance(const T& until) {
    if (stopped()) return Status::interrupted;
    for (;;) {
      const Status status = engine_.advance(until, observer_);
      if (status != Status::interrupted || stopped()) return status;
      keep(engine_.last_collision_time());
    }
  }

  // ---- what is recorded
  // (scene_run_samples.hpp)
  bool sample_at(const T& time);
  void record_collision(const Collision<T>& c);
  Profile profile_at(const Configuration<T>& now, const T& time) const;
  void record_sample(const Given<T>& at);
  void notify_observer(const T& time, bool at_collision) {
    options_.observer->sample(run_sample(scene_, plan_, engine_, energy_, time, at_collision));
  }
  static std::string numbered(const char* folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

  // ---- how it ends (scene_run_end.hpp)
  void record_end(const T& time);
  RunOutcome finish(Status status, const T& time);
  T ledger_error(const T& time) const;
  void put_tables(RunOutcome& end, const T& time);

  const Scene& scene_;
  const RunOptions& options_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  T energy_;
  Engine<T>& engine_;
  Progress& progress_;
  Schedule<T> plan_;
  std::optional<T> inspected_;                               // the last time inspected
  std::uint64_t snapshots_ = 0, profiles_ = 0, masses_ = 0;  // tables written
  SeriesRecorder<T> series_;
  HeaviestRecorder<T> heaviest_;
  std::optional<ZoneAverage> zone_;
  std::optional<TimeAverages> averages_;
  std::optional<HistogramRecorder<T>> histograms_;
  std::optional<CorrelationRecorder<T>> correlations_;
  std::optional<WordRecorder> word_;
  ScenarioWatch scenario_;
  EventRecorder<T> events_;
  Observer<T> observer_;
  RunGuards<T> guards_;
  GrowingTables tables_;  // used if there is no store
};

}  // namespace cradle::tools

#include "cradle/tools/run/scene_run_end.hpp"
#include "cradle/tools/run/scene_run_samples.hpp"
