// A run of a scene in one scalar type (scene_run.hpp): the engine, which advances from one output time to the next, and
// what is recorded there. At the end the records become tables and texts. Compiled once per scalar type
// (tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cradle/tools/engines/engine_of.hpp"
#include "cradle/tools/record/columns.hpp"
#include "cradle/tools/record/correlations.hpp"
#include "cradle/tools/record/histograms.hpp"
#include "cradle/tools/record/recorder.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/record/word.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/run/run_sample.hpp"
#include "cradle/tools/run/scene_run.hpp"
#include "cradle/tools/theory/cost.hpp"

namespace cradle::tools {

template <Real T> class SceneRunIn final : public SceneRun {
  static constexpr std::size_t most_rows = 1 << 14;  // rows that wait for the sink

 public:
  SceneRunIn(const Scene& scene, const RunOptions& options, Sink& sink)
      : scene_(scene), options_(options), sink_(sink), particles_(initial_particles<T>(scene)),
        energy_(particles_->kinetic_energy()),
        progress_(options.progress, scene.run.start.value, scene.run.until.value,
                  options.progress != Progress::Show::never && expected_cost(scene).predictable()),
        engine_(engine()), plan_(schedule<T>(scene)), series_(scene), guards_(scene, *particles_, *engine_),
        time_(number<T>(scene.run.start), scene.run.start.text), end_(number<T>(scene.run.until)) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
    if (!plan_.averages.empty()) averages_.emplace(time_averages(scene, plan_.averages.size()));
    if (!scene.output.histograms.empty()) histograms_.emplace(scene, particles_->count());
    if (CorrelationRecorder<T>::wanted(scene.output)) correlations_.emplace(scene, *particles_, plan_);
    if (scene.output.word) word_.emplace(scene);
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    observe({});
    if (StateSource* from = sink.loaded_from()) load(*from);
  }

  const Scene& scene() const override { return scene_; }

  void advance(const Decimal& until) override {
    const Given<T> time = checked(until);
    computing([&] { stand(pass(time.value, [this](const T& to) { return advance_engine(to); }), time); });
  }
  std::uint64_t step(std::uint64_t n, const Decimal& until) override {
    const Given<T> time = checked(until);
    if (n > 0)
      computing([&] {
        const Status status = pass(time.value, [&](const T& to) {
          const Status made = engine_->step(n, to, observer_);
          return made == Status::reached && n == 0 ? Status::interrupted : made;
        });
        status == Status::interrupted&& n == 0 ? stand_at_last_collision() : stand(status, time);
      });
    return n;
  }
  void stop() override {
    require_in_progress();
    if (failed_) throw *failed_;
    end_with(Status::interrupted);
  }
  /// The observer comes before what records collisions, so that nothing of a collision is recorded if it throws.
  void observe(std::function<void(const HeldCollision&)> observer) override;

  const RunOutcome* over() const override { return over_ ? &*over_ : nullptr; }
  const Counts& counts() const override { return engine_->counts(); }
  double time() const override { return time_.rounded; }
  std::string time_text() const override { return time_.text; }
  double energy() const override { return to_double(energy_now(*engine_, energy_, time_.value)); }
  std::string energy_text() const override { return to_text(energy_now(*engine_, energy_, time_.value)); }
  std::vector<double> column(Column which) override {
    return made_of<double>(which, [](const T& number) { return to_double(number); });
  }
  std::vector<std::string> column_text(Column which) override {
    return made_of<std::string>(which, [](const T& number) { return to_text(number); });
  }
  const std::vector<ParticleIndex>& index() override { return now().index; }

  void put_rows() override {
    if (histograms_) histograms_->made(engine_->counts());
    put(series_.take());
    if (has_clouds(scene_)) put(heaviest_.take());
    if (!scene_.output.events) return;
    events_.made(engine_->counts());
    put(events_.take());
  }
  void save(StateSink& to) override {
    require_in_progress();
    save_state(to);
  }
  void load(StateSource& from) override {
    try {
      std::pair<std::string, std::string> kind;
      cradle::load(from, kind);
      if (kind != std::pair(shape(), precision_name(scene_.run)))
        throw Error({}, "a checkpoint of another build or precision", "", "continue with the program that wrote it",
                    Exit::io);
      engine_->load(from);
      cradle::load(from, *this);
    } catch (const std::invalid_argument& error) {
      throw Error(std::string("the checkpoint cannot be extended: ") + error.what(), Exit::io);
    }
    from.end();
    const T last = engine_->last_collision_time();
    guards_.check_loaded(inspected_ && last < *inspected_ ? *inspected_ : last);
    progress_.continue_from(to_double(last), engine_->counts().collisions);
  }

  // What is saved besides the engine's state: how much of the plan is done, and what observers have collected.
  static auto state(auto& self) {
    return std::tie(self.time_, self.at_collision_, self.inspected_, self.snapshots_, self.profiles_, self.masses_,
                    self.zone_, self.scenario_, self.averages_, self.histograms_, self.correlations_, self.word_,
                    self.guards_);
  }

  void loaded() const {
    require_state(zone_.has_value() == scene_.output.zone.from.has_value(), "zone");
    require_state(averages_.has_value() == !plan_.averages.empty(), "averages");
    require_state(histograms_.has_value() == !scene_.output.histograms.empty(), "histograms");
    require_state(correlations_.has_value() == CorrelationRecorder<T>::wanted(scene_.output), "correlations");
    require_state(word_.has_value() == scene_.output.word.has_value(), "word");
  }

 private:
  // ---- how it advances

  std::unique_ptr<Engine<T>> engine() {
    Policy<T> policy;
    // Elastic particles collapse only against a wall that loses energy; particles that stick do not collapse.
    if (stops_at_collapse(scene_) &&
        (scene_.law.restitution < Decimal("1") || scene_.walls.left.dissipates() || scene_.walls.right.dissipates()))
      policy.collapse = cradle::CollapsePolicy::stop;
    if (scene_.run.stop_gap) policy.stop_gap = number<T>(*scene_.run.stop_gap);
    policy.interrupt = [this] { return stopped() || sink_.due(); };
    policy.progress = [this](const T& time, const Counts& counts) {
      progress_.report(to_double(time), counts.collisions);
      sink_.count(counts.collisions);
    };
    if constexpr (std::same_as<T, double>) {
      if (options_.restitution) return engine_with(options_.restitution, scene_, particles_, policy);
    } else if (options_.restitution) {
      throw Error({scene_.name, 0, "run.precision"}, "a restitution that is a function is of type double",
                  precision_name(scene_.run), "give run.precision = \"double\"");
    }
    return engine_of<T>(scene_, particles_, policy, options_.workers,
                        scene_.output.observes_collisions() || options_.observer != nullptr || options_.held);
  }

  bool stopped() const { return options_.interrupt != nullptr && options_.interrupt->signal() != 0; }
  Status advance_engine(const T& until) {
    if (stopped()) return Status::interrupted;
    for (;;) {
      const Status status = engine_->advance(until, observer_);
      if (status != Status::interrupted || stopped()) return status;
      keep(engine_->last_collision_time());
    }
  }
  // Records at every output time up to `until`. `advance(time)` makes the collisions up to a time.
  template <class Advance> Status pass(const T& until, const Advance& advance) {
    for (;;) {
      const auto& stops = plan_.stops;
      const auto next = inspected_ ? std::upper_bound(stops.begin(), stops.end(), *inspected_) : stops.begin();
      const bool stop = next != stops.end() && !(until < *next);
      if (!stop && inspected_ && !(*inspected_ < until)) return Status::reached;
      const Status status = advance(stop ? *next : until);
      if (status != Status::reached || !stop) return status;
      if (!sample_at(*next)) return Status::interrupted;
      progress_.report(to_double(*next), engine_->counts().collisions);
    }
  }

  template <class F> void computing(const F& f) {
    if (failed_) throw *failed_;
    now_.reset();
    try {
      f();
    } catch (const Error& error) {  // not of a caller's function: the run has failed
      failed_ = error;
      throw;
    } catch (...) {
      stand_at_last_collision();
      throw;
    }
  }
  // The time does not step back if there was no collision.
  void stand_at_last_collision() {
    const T last = engine_->last_collision_time();
    if (last < time_.value) return;
    time_ = Given<T>(last), at_collision_ = true;
  }
  void stand(Status status, const Given<T>& time) {
    if (status == Status::reached)
      time_ = time, at_collision_ = false;
    else
      stand_at_last_collision();
    if (status != Status::reached || !(time.value < end_)) end_with(status);
  }

  // The time to advance to.
  Given<T> checked(const Decimal& until) const {
    require_in_progress();
    const Given<T> time(number<T>(until), until.text);
    const auto refuse = [&](const char* wrong, const std::string& advice) {
      throw Error({scene_.name, 0, ""}, wrong, until.text, advice);
    };
    if (time.value < time_.value)
      refuse("a time in the past", "the run is at t = " + time_.text + " and goes forward only");
    if (end_ < time.value) refuse("a time after the end", "the end is run.until = " + scene_.run.until.text);
    return time;
  }
  void require_in_progress() const {
    if (over_)
      throw Error({scene_.name, 0, ""}, "the run is over",
                  std::string(end_row(over_->end).text) + " at t = " + time_.text,
                  "write its result, or begin another one");
  }

  const Configuration<T>& now() {
    if (!now_) now_ = at_collision_ ? engine_->configuration_at_last_collision() : engine_->configuration(time_.value);
    return *now_;
  }
  template <class Number, class F> std::vector<Number> made_of(Column which, const F& number) {
    const Configuration<T>& c = now();
    std::vector<Number> numbers;
    for (const T& each : *std::array{&c.x, &c.v, &c.m, &c.gap, &c.closing_speed}[static_cast<std::size_t>(which)])
      numbers.push_back(number(each));
    return numbers;
  }

  // ---- what goes to the sink

  std::string shape() const { return engine_->shape() + state_shape<SceneRunIn>() + std::string(exact_part<T>); }
  void save_state(StateSink& to) const {
    cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
    engine_->save(to);
    cradle::save(to, *this);
  }
  // Gives it the recorded rows and, from time to time, the state.
  void keep(const T& time, RunIs run_is = RunIs::in_progress) {
    put_rows();
    RunStatus now = guards_.status();
    now.time = plan_.meant(time).rounded;
    now.collisions = engine_->counts().collisions;
    sink_.keep(
        now, [this](StateSink& to) { save_state(to); }, run_is);
  }
  void put(Recorded<T>&& rows) {
    for (Group& table : tables(std::move(rows), sink_.for_file()))
      if (!has_nothing(table)) sink_.add(std::move(table));
  }

  // ---- what is recorded
  // (scene_run_samples.hpp)
  bool sample_at(const T& time);
  void record_collision(const Collision<T>& c);
  Profile profile_at(const Configuration<T>& now, const T& time) const;
  void record_sample(const Given<T>& at);
  void notify_observer(const T& time, bool at_collision) {
    options_.observer->sample(run_sample(scene_, plan_, *engine_, energy_, time, at_collision));
  }
  static std::string numbered(const char* folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

  // ---- how it ends (scene_run_end.hpp)
  void end_with(Status status);
  void record_end(const T& time);
  RunOutcome outcome(Status status, const T& time, std::vector<Attribute>& attributes);
  T ledger_error(const T& time) const;
  void put_tables(RunOutcome& end, const T& time);

  const Scene& scene_;
  RunOptions options_;
  Sink& sink_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  T energy_;
  Progress progress_;
  std::unique_ptr<Engine<T>> engine_;
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
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();

  Given<T> time_;
  T end_;
  bool at_collision_ = false;  // the state is the one right after the last collision
  std::optional<Configuration<T>> now_;
  std::optional<RunOutcome> over_;
  std::optional<Error> failed_;
};

template <class T> std::unique_ptr<SceneRun> begin_in(const Scene& scene, const RunOptions& options, Sink& sink) {
  return std::make_unique<SceneRunIn<T>>(scene, options, sink);
}

}  // namespace cradle::tools

#include "cradle/tools/run/scene_run_end.hpp"
#include "cradle/tools/run/scene_run_samples.hpp"
