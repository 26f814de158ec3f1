#include "cradle/core/base/fields.hpp"
#include "cradle/tools/run/run.hpp"

#include <chrono>
#include <utility>

#include "cradle/tools/record/measurements.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/theory/theory.hpp"

namespace cradle::tools {

namespace {

// What is saved besides the state of the engine, of measurements and of guards: how much of the plan is done.
struct SavedTimes {
  std::string time, meant;
  double rounded = 0;
  bool at_collision = false;
  std::optional<std::string> inspected = {};
  static auto state(auto& self) {
    return fields(self.time, self.meant, self.rounded, self.at_collision, self.inspected);
  }
};

// The engine of a run, which advances from one output time to the next, and what is measured there.
class EngineRun final : public SceneRun {
 public:
  EngineRun(const Scene& scene, const RunOptions& options, Sink& sink)
      : SceneRun(scene), options_(options), sink_(sink), round_(rounding(scene)),
        progress_(options.progress, scene.run.start.value, scene.run.until.value,
                  options.progress != Progress::Show::never && expected_cost(scene).predictable()),
        engine_(engine()), plan_(scene),
        measurements_(scene, *engine_, plan_, sink.for_file() && scene.run.precision != Precision::double_),
        guards_(scene, *engine_), start_(round_(scene.run.start.text), scene.run.start.text), time_(start_),
        end_(round_(scene.run.until.text), scene.run.until.text) {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    observe({});
    if (StateSource* from = sink.loaded_from()) load(*from);
  }

  void begin_again() override {
    engine_->begin_again();
    measurements_.begin_again();
    guards_.begin_again();
    observe({});  // the counts of another engine
    inspected_.reset(), now_.reset(), failed_.reset(), over_.reset();
    time_ = start_, at_collision_ = false;
  }
  void advance(const Decimal& until) override {
    const RunTime time = checked(until);
    computing([&] { stand(pass(time.exact, [this](const Number& to) { return advance_engine(to); }), time); });
  }
  std::uint64_t step(std::uint64_t n, const Decimal& until) override {
    const RunTime time = checked(until);
    if (n > 0)
      computing([&] {
        const Status status = pass(time.exact, [&](const Number& to) {
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
  // The observer comes before what records collisions, so that nothing of a collision is recorded if it throws.
  void observe(CollisionObserver observer) override {
    observer_ = {};
    const auto also = [this](CollisionObserver added) {
      observer_ = observer_ ? [before = observer_, added](const ObservedCollision& c) { before(c), added(c); }
                            : std::move(added);
    };
    if (observer) also(std::move(observer));
    measurements_.observe(engine_->counts(), sink_, also);
    if (options_.observer != nullptr)
      also([this](const ObservedCollision& c) { options_.observer->collision(c.left, c.right, c.time); });
  }

  const Counts& counts() const override { return engine_->counts(); }
  Number time() const override { return time_.meant; }
  const RunState& now() override {
    if (!now_) now_ = engine_->state_at(time_, at_collision_);
    return *now_;
  }

  void put_rows() override { measurements_.put_rows(engine_->counts(), sink_); }
  void save(StateSink& to) override {
    require_in_progress();
    cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
    engine_->save(to);
    const auto inspected = inspected_ ? std::optional(inspected_->text()) : std::nullopt;
    cradle::save(to, SavedTimes{time_.exact.text(), time_.meant.text(), time_.meant.value, at_collision_, inspected});
    cradle::save(to, *this);
  }
  void load(StateSource& from) override {
    try {
      std::pair<std::string, std::string> kind;
      cradle::load(from, kind);
      if (kind != std::pair(shape(), precision_name(scene_.run)))
        throw Error({}, "a checkpoint of another build or precision", "", "continue with the program that wrote it",
                    Exit::io);
      engine_->load(from);
      SavedTimes times;
      cradle::load(from, times);
      cradle::load(from, *this);
      time_ = RunTime(round_(times.time), times.rounded, times.meant);
      at_collision_ = times.at_collision;
      inspected_ = times.inspected ? std::optional(round_(*times.inspected)) : std::nullopt;
    } catch (const std::invalid_argument& error) {
      throw Error({}, "a checkpoint that cannot be continued", error.what(),
                  "use the program that wrote it, or begin anew", Exit::io);
    }
    from.end();
    const Number last = engine_->last_collision_time();
    guards_.check_loaded(inspected_ && last < *inspected_ ? *inspected_ : last);
    progress_.continue_from(last.value, engine_->counts().collisions);
  }

  static auto state(auto& self) { return fields(self.measurements_, self.guards_); }

 private:
  // ---- how it advances
  std::unique_ptr<AnyEngine> engine() {
    return begin_engine(
        scene_, {.interrupt = [this] { return stopped() || sink_.due(); },
                 .progress =
                     [this](double time, const Counts& counts) {
                       progress_.report(time, counts.collisions);
                       sink_.count(counts.collisions);
                     },
                 .workers = options_.workers,
                 .observed = scene_.output.observes_collisions() || options_.observer != nullptr || options_.held,
                 .restitution = options_.restitution});
  }

  bool stopped() const { return options_.interrupt != nullptr && options_.interrupt->signal() != 0; }
  Status advance_engine(const Number& until) {
    if (stopped()) return Status::interrupted;
    for (;;) {
      const Status status = engine_->advance(until, observer_);
      if (status != Status::interrupted || stopped()) return status;
      keep(engine_->last_collision_time());
    }
  }
  // Records at every output time up to `until`. `advance(time)` makes the collisions up to a time.
  template <class Advance> Status pass(const Number& until, const Advance& advance) {
    for (;;) {
      const std::optional<Number> next = plan_.next(inspected_);
      const bool stop = next && !(until < *next);
      if (!stop && inspected_ && !(*inspected_ < until)) return Status::reached;
      const Status status = advance(stop ? *next : until);
      if (status != Status::reached || !stop) return status;
      if (!sample_at(*next)) return Status::interrupted;
      progress_.report(next->value, engine_->counts().collisions);
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
    const Number last = engine_->last_collision_time();
    if (last < time_.exact) return;
    time_ = last, at_collision_ = true;
  }
  void stand(Status status, const RunTime& time) {
    if (status == Status::reached)
      time_ = time, at_collision_ = false;
    else
      stand_at_last_collision();
    if (status != Status::reached || !(time.exact < end_.exact)) end_with(status);
  }

  // The time to advance to.
  RunTime checked(const Decimal& until) const {
    require_in_progress();
    if (until.text == scene_.run.until.text) return end_;
    const RunTime time(round_(until.text), until.text);
    if (time.exact < time_.exact)
      throw Error({scene_.name}, "a time in the past", until.text,
                  "the run is at t = " + time_.meant.text() + " and goes forward only");
    if (end_.exact < time.exact)
      throw Error({scene_.name}, "a time after the end", until.text, "the end is run.until = " + scene_.run.until.text);
    return time;
  }

  // ---- what goes to the sink
  std::string shape() const { return engine_->shape() + state_shape<SavedTimes>() + state_shape<EngineRun>(); }
  // Gives it the recorded rows and, from time to time, the state.
  void keep(const Number& time, RunIs run_is = RunIs::in_progress) {
    put_rows();
    const auto saved = [this](StateSink& to) { save(to); };
    sink_.keep(guards_.status(plan_.meant(time).meant.value), saved, run_is);
  }

  // ---- what is recorded
  // Returns false if a signal has stopped a loop over rows, which can be very long; then nothing of this time is
  // recorded yet.
  bool sample_at(const Number& time) {
    std::unique_ptr<RunState> state = engine_->state_at(plan_.meant(time));
    const RunState& now = *state;
    if (measurements_.come_to(time)) guards_.require_held(now, true);
    try {
      measurements_.find(now, [this] { return stopped(); });
    } catch (const WalkStopped&) {
      return false;
    }
    if (measurements_.series_is_due()) guards_.require_held(now, false);
    measurements_.record(now, sink_);
    guards_.check(now, !(time < plan_.last()));
    inspected_ = time;
    notify_observer(now, false);
    sink_.check_clock();
    if (sink_.due()) keep(time);
    if (measurements_.many_rows()) put_rows();
    if (sink_.for_statistics()) now_ = std::move(state);
    return true;
  }
  void notify_observer(const RunState& now, bool at_collision) {
    if (options_.observer != nullptr) options_.observer->sample({now, scene_, plan_, engine_->epsilon(), at_collision});
  }

  void end_with(Status status) {
    const bool reached = status == Status::reached, interrupted = status == Status::interrupted;
    const Number end = reached ? plan_.last() : engine_->last_collision_time();
    if ((reached || interrupted) && !sink_.for_statistics()) keep(end, reached ? RunIs::over : RunIs::interrupted);
    if (!reached || !now_) now_ = engine_->state_at(reached ? plan_.meant(end) : RunTime(end));
    const std::unique_ptr<RunState> state = std::move(now_);
    const RunState& now = *state;
    if (!reached && !(interrupted && sink_.for_file())) {  // its last state
      guards_.require_between_walls(now);
      notify_observer(now, true);
      guards_.require_held(now, false);
      measurements_.record_last(now, sink_);
    }
    put_rows();
    if (sink_.for_statistics()) {
      over_ = outcome_of(scene_, *engine_, now, status);
      over_->summary = measurements_.finish(now, sink_);
      return;
    }
    RunEnding ending(scene_, *engine_, now, status);
    ending.outcome.summary = measurements_.finish(now, sink_);
    for (Group& table : ending.collapse) sink_.add(std::move(table));
    ending.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
    std::vector<Attribute> attributes;
    if (sink_.for_file()) attributes = provenance(scene_, precision_name(scene_.run), end_row(ending.outcome.end).text);
    append(attributes, std::move(ending.attributes));
    sink_.end(std::move(attributes), ending.outcome.end);
    over_ = std::move(ending.outcome);
  }

  RunOptions options_;
  Sink& sink_;
  Rounding round_;
  Progress progress_;
  std::unique_ptr<AnyEngine> engine_;
  Schedule plan_;
  std::optional<Number> inspected_;  // the last time inspected
  Measurements measurements_;
  CollisionObserver observer_;
  RunGuards guards_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();

  RunTime start_, time_, end_;
  bool at_collision_ = false;      // the state is the one right after the last collision
  std::unique_ptr<RunState> now_;  // for who reads the run, or of the last sample of a run for statistics
  std::optional<Error> failed_;
};

}  // namespace

std::unique_ptr<SceneRun> begin_run(const Scene& scene, const RunOptions& options, Sink& sink) {
  check_built(scene);
  if (scene.initial.type == InitialType::clusters)
    throw Error(scene.place("initial.type"), "a model without particles", "clusters", "use `cradle run`");
  return std::make_unique<EngineRun>(scene, options, sink);
}

}  // namespace cradle::tools
