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
#include "cradle/tools/run/engine.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/run/run_sample.hpp"
#include "cradle/tools/store/run_journal.hpp"

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
  void save(StateWriter& to) const {
    cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
    engine_.save(to);
    cradle::save(to, *this);
  }
  void load(StateReader& from) {
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
    now.time = to_double(time);
    now.collisions = engine_.counts().collisions;
    options_.store->keep(
        now, [this](StateWriter& to) { save(to); }, run_is);
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
  // Returns false if a signal has stopped a loop over rows, which can be very long; then nothing of this time is
  // recorded yet.
  bool sample_at(const T& time) {
    const bool snapshot = holds(plan_.snapshots, time), profiled = holds(plan_.profiles, time),
               masses = holds(plan_.masses, time), zone = holds(plan_.zone, time),
               averaged = holds(plan_.averages, time), counted = holds(plan_.counting, time),
               correlated = correlations_ && correlations_->due(time);
    std::optional<Configuration<T>> now;
    std::optional<Profile> seen;
    if (snapshot || profiled || masses || zone || averaged || counted || correlated) now = engine_.configuration(time);
    if (now) guards_.require_held(*now);
    try {
      if (profiled) seen = profile_at(*now, time);
      const T elapsed = time - number<T>(scene_.run.start);
      const auto stop = [this] { return stopped(); };
      if (averaged) averages_->find(*now, *particles_, elapsed, stop);
      if (correlated) correlations_->find(*now, time, stop);
      if (zone) zone_->add(*now, *particles_, elapsed, stop);
    } catch (const WalkStopped&) {
      return false;
    }
    if (averaged) averages_->add_found();
    if (counted) histograms_->add(*now);
    if (correlated) correlations_->add(time, [this](Group&& table) { put(std::move(table)); });
    if (holds(plan_.series, time)) record_sample(time);
    if (snapshot) put(snapshot_rows(*now, numbered("snapshots", snapshots_)));
    if (seen) put(profile_table(std::move(*seen), numbered("profiles", profiles_)));
    if (masses) put(masses_table(*now, particles_->least_mass(), numbered("masses", masses_)));
    guards_.check(time, !(time < plan_.stops.back()));
    inspected_ = time;
    if (options_.observer != nullptr) notify_observer(time, false);
    if (options_.store == nullptr) return true;
    options_.store->check_clock();
    if (options_.store->due())
      keep(time);
    else if (series_.rows() >= most_rows)
      put_rows();
    return true;
  }
  void record_collision(const Collision<T>& c) {
    events_.made(engine_.counts());
    if (options_.store != nullptr && events_.rows() >= most_rows) put(events_.take());
    events_(c);
  }

  Profile profile_at(const Configuration<T>& now, const T& time) const {
    const auto& wanted = scene_.output.profiles;
    const T elapsed = time - number<T>(scene_.run.start);
    BinRange range{to_double(now.x.front()), to_double(now.x.back())};
    if (!wanted.range.empty())
      range = {wanted.range[0].value, wanted.range[1].value};
    else if (engine_.collided_particles() > 0 && !engine_.on_ring())
      range = {to_double(engine_.front_left(time)), to_double(engine_.front_right(time))};
    if (!(range.from < range.to)) range.to = range.from + 1;  // all particles at one place: the range has length 1
    if (!std::isfinite(range.to - range.from))
      throw Error({scene_.name, 0, "output.profiles.range"}, "not given, and the particles are where no double reaches",
                  to_text(time), "give it, or remove output.profiles", Exit::lost);
    return profile(now, *particles_, elapsed, range, wanted.bins, [this] { return stopped(); });
  }

  void record_sample(const T& time) {
    const Moment<T> now(engine_, particles_, number<T>(scene_.run.start), time);
    guards_.require_held(now.state.energy, "the energy", time);
    for (const auto& front : {now.state.front_left, now.state.front_right})
      if (front) guards_.require_held(*front, "a front", time);
    series_.add(now);
    if (!has_clouds(scene_)) return;
    heaviest_.add(now.cloud());
    if (scene_.output.scenario)
      scenario_.sample(now.cloud(), to_double(T(time - number<T>(scene_.run.start))), engine_.counts().merges);
  }

  void notify_observer(const T& time, bool at_collision) {
    options_.observer->sample(run_sample(scene_, plan_, engine_, energy_, time, at_collision));
  }
  // Records the last state of a run that ends early.
  void record_end(const T& time) {
    if (options_.observer != nullptr) notify_observer(time, true);
    record_sample(time);
    put(snapshot_rows(engine_.configuration_at_last_collision(), numbered("snapshots", snapshots_)));
  }

  static std::string numbered(const char* folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

  RunOutcome finish(Status status, const T& time) {
    const Counts& counts = engine_.counts();
    RunOutcome end;
    end.end = end_of(status, engine_.account().order_lost > 0);
    if (end.end == RunEnd::collapsed && !engine_.collapse()->settled) end.end = RunEnd::small_gap;
    end.collisions = counts.collisions;
    end.merges = counts.merges;
    end.time = to_double(time);
    end.energy = to_double(energy_now(engine_, energy_, time));
    end.energy_digits = energy_digits(engine_, scene_, to_double(energy_), end.energy);
    ReportedAccount account = reported(engine_.account());
    if (const auto particle = engine_.uncertain_at(time); particle && !account.uncertain && status == Status::reached) {
      account.uncertain_end = true;
      account.first_uncertain = {to_text(time), to_double(time), 0, *particle};
    }
    end.warning = account_warning(account, scene_.run);
    if (status == Status::exhausted) end.warning += exhausted_warning(to_text(time), counts.collisions, scene_.run);
    end.result.attributes = provenance(scene_, precision_name(scene_.run), end_row(end.end).text);
    for (const Attribute& attribute :
         {Attribute("simultaneous_collisions", account.simultaneous), Attribute("order_lost", account.order_lost),
          Attribute("unresolved_gaps", account.unresolved), Attribute("energy_digits", end.energy_digits),
          Attribute("ledger_error", to_double(ledger_error(time)))})
      end.result.attributes.push_back(attribute);
    if (account.uncertain || account.uncertain_end)
      end.result.attributes.emplace_back("uncertain_from", account.first_uncertain.value);
    put_tables(end, time);
    if (status == Status::collapsed) {
      const ReportedCollapse collapse = reported(*engine_.collapse());
      end.report = collapse_report(collapse, counts.collisions);
      end.collapse_time = (collapse.settled ? collapse.time : collapse.last_collision).digits;
      end.result.groups.push_back(collapse_table(collapse));
    }
    return end;
  }

  // What the ledger leaves of the energy minus the sums over particles.
  T ledger_error(const T& time) const {
    T error = energy_ - engine_.energy_lost(time) - engine_.kinetic_energy(time);
    if (particles_->fall())
      error += particles_->potential_energy() - cradle::potential_energy(engine_.configuration(time), *particles_,
                                                                         T(time - number<T>(scene_.run.start)));
    return error;
  }

  void put_tables(RunOutcome& end, const T& time) {
    put_rows();
    std::vector<Group>& groups = end.result.groups;
    groups = std::move(tables_).in_order();
    // The table is written even if there was no collision.
    if (scene_.output.events && options_.store != nullptr) append(groups, tables(events_.take(), true));
    if (scene_.output.events) {
      const Configuration<T> now = engine_.configuration_at_last_collision();
      append(groups, tables(initial_rows(*particles_, now.from, now.to), options_.store != nullptr));
    }
    if (word_) groups.push_back(word_->table());
    if (zone_) {
      const double single = 2 * std::sqrt(scene_.law.loss.value);  // u_crit of single particles
      const ZoneWidth width = zone_->width(scene_.initial.speed.value, single);
      groups.push_back(zone_result(*zone_, width, scene_));
      end.summary.emplace_back("zone_width", width.width);
    }
    // Ensembles combine what covers the whole time only.
    const bool partial = options_.store != nullptr;
    if (averages_ && averages_->samples() > 0 && (partial || averages_->complete()))
      groups.push_back(averages_result(*averages_, scene_));
    if (histograms_ && (partial || !(time < number<T>(scene_.output.counting.until))))
      append(groups, histograms_->tables());
    if (correlations_) append(groups, correlations_->tables(partial));
    if (scene_.output.scenario) {
      const auto numbers = scenario_numbers(scenario_.result(engine_.counts().merges));
      groups.push_back({"scenario", {numbers.begin(), numbers.end()}, {}});
      end.summary.insert(end.summary.end(), numbers.begin(), numbers.end());
    }
  }

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
