// A run of a scene in one scalar type (scene_run.hpp): the engine, which advances from one output time to the next, and
// what is measured there. Compiled once per scalar type (tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/tools/engines/engine_of.hpp"
#include "cradle/tools/record/measurements.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/run/run_ending.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/run/run_sample.hpp"
#include "cradle/tools/run/scene_run.hpp"
#include "cradle/tools/theory/cost.hpp"

namespace cradle::tools {

template <Real T> class SceneRunIn final : public SceneRun {
 public:
  SceneRunIn(const Scene& scene, const RunOptions& options, Sink& sink)
      : SceneRun(scene), options_(options), sink_(sink), particles_(initial_particles<T>(scene)),
        energy_(particles_->kinetic_energy()),
        progress_(options.progress, scene.run.start.value, scene.run.until.value,
                  options.progress != Progress::Show::never && expected_cost(scene).predictable()),
        engine_(engine()), plan_(schedule<T>(scene)), measurements_(scene, *particles_, plan_),
        guards_(scene, *particles_, *engine_), time_(number<T>(scene.run.start), scene.run.start.text),
        end_(number<T>(scene.run.until)) {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    observe({});
    if (StateSource* from = sink.loaded_from()) load(*from);
  }

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
        const bool made = status == Status::interrupted && n == 0;
        made ? stand_at_last_collision() : stand(status, time);
      });
    return n;
  }
  void stop() override {
    require_in_progress();
    if (failed_) throw *failed_;
    end_with(Status::interrupted);
  }
  /// The observer comes before what records collisions, so that nothing of a collision is recorded if it throws.
  void observe(std::function<void(const HeldCollision&)> observer) override {
    observer_ = {};
    const auto also = [this](const Observer<T>& added) {
      observer_ = observer_ ? [before = observer_, added](const Collision<T>& c) { before(c), added(c); } : added;
    };
    if (observer)
      also([observer = std::move(observer)](const Collision<T>& c) {
        observer({c.left, c.right, to_double(T(c.time.value())), to_double(c.interval), to_double(c.closing_speed)});
      });
    measurements_.observe(engine_->counts(), sink_, also);
    if (options_.observer != nullptr)
      also([this](const Collision<T>& c) {
        options_.observer->collision(c.left, c.right, to_double(T(c.time.value())));
      });
  }

  const Counts& counts() const override { return engine_->counts(); }
  Number time() const override { return time_.number(); }
  Number energy() const override { return number_of(energy_now(*engine_, energy_, time_.value)); }
  std::vector<double> column(Column which) override {
    return made_of<double>(which, [](const T& number) { return to_double(number); });
  }
  std::vector<std::string> column_text(Column which) override {
    return made_of<std::string>(which, [](const T& number) { return to_text(number); });
  }
  const std::vector<ParticleIndex>& index() override { return now().index; }

  void put_rows() override { measurements_.put_rows(engine_->counts(), sink_); }
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
    return std::tie(self.time_, self.at_collision_, self.inspected_, self.measurements_, self.guards_);
  }

 private:
  // ---- how it advances
  std::unique_ptr<Engine<T>> engine() {
    Policy<T> policy = policy_of<T>(scene_);
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
    if (time.value < time_.value)
      throw Error({scene_.name, 0, ""}, "a time in the past", until.text,
                  "the run is at t = " + time_.text + " and goes forward only");
    if (end_ < time.value)
      throw Error({scene_.name, 0, ""}, "a time after the end", until.text,
                  "the end is run.until = " + scene_.run.until.text);
    return time;
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
    const RunStatus now = guards_.status(plan_.meant(time).rounded);
    sink_.keep(
        now, [this](StateSink& to) { save_state(to); }, run_is);
  }

  // ---- what is recorded
  MomentIn<T> moment(const Given<T>& at) const { return {*engine_, particles_, number<T>(scene_.run.start), at}; }
  // Returns false if a signal has stopped a loop over rows, which can be very long; then nothing of this time is
  // recorded yet.
  bool sample_at(const T& time) {
    const MomentIn<T> now = moment(plan_.meant(time));
    if (measurements_.need_particles(time)) guards_.require_held(now.configuration());
    try {
      measurements_.find(now, [this] { return stopped(); });
    } catch (const WalkStopped&) {
      return false;
    }
    if (plan_.series().hold(time)) guards_.require_held(now.state());
    measurements_.record(now, sink_);
    guards_.check(time, !(time < plan_.stops.back()));
    inspected_ = time;
    if (options_.observer != nullptr) notify_observer(time, false);
    sink_.check_clock();
    if (sink_.due())
      keep(time);
    else if (measurements_.many_rows())
      put_rows();
    return true;
  }
  void notify_observer(const T& time, bool at_collision) {
    options_.observer->sample(run_sample(scene_, plan_, *engine_, energy_, time, at_collision));
  }
  // The last state of a run that ends early.
  void record_last(const MomentIn<T>& now) {
    guards_.require_between_walls(now.time.value);
    if (options_.observer != nullptr) notify_observer(now.time.value, true);
    guards_.require_held(now.state());
    measurements_.record_last(now, sink_);
  }

  void end_with(Status status) {
    const bool reached = status == Status::reached, interrupted = status == Status::interrupted;
    const T end = reached ? plan_.stops.back() : engine_->last_collision_time();
    if (reached || interrupted) keep(end, reached ? RunIs::over : RunIs::interrupted);
    const MomentIn<T> now = moment(reached ? plan_.meant(end) : Given<T>(end));
    if (!reached && !(interrupted && sink_.for_file())) record_last(now);
    RunEnding<T> ending(scene_, now, status);
    put_rows();
    ending.outcome.summary = measurements_.finish(now, sink_);
    if (ending.collapse) sink_.add(std::move(*ending.collapse));
    ending.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
    sink_.end(std::move(ending.attributes), ending.outcome.end);
    over_ = std::move(ending.outcome);
  }

  RunOptions options_;
  Sink& sink_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  T energy_;
  Progress progress_;
  std::unique_ptr<Engine<T>> engine_;
  Schedule<T> plan_;
  std::optional<T> inspected_;  // the last time inspected
  Measurements<T> measurements_;
  Observer<T> observer_;
  RunGuards<T> guards_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();

  Given<T> time_;
  T end_;
  bool at_collision_ = false;  // the state is the one right after the last collision
  std::optional<Configuration<T>> now_;
  std::optional<Error> failed_;
};

template <class T> std::unique_ptr<SceneRun> begin_in(const Scene& scene, const RunOptions& options, Sink& sink) {
  return std::make_unique<SceneRunIn<T>>(scene, options, sink);
}

}  // namespace cradle::tools
