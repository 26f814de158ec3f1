// The engine of a run, which advances from one output time to the next, and what is measured there.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "cradle/tools/engines/precision.hpp"
#include "cradle/tools/record/measurements.hpp"
#include "cradle/tools/run/run_guards.hpp"
#include "cradle/tools/run/run_sample.hpp"
#include "cradle/tools/run/scene_run.hpp"
#include "cradle/tools/theory/cost.hpp"

namespace cradle::tools {

// What is saved besides the state of the engine, of measurements and of guards: how much of the plan is done.
struct SavedTimes {
  std::string time, meant;
  double rounded = 0;
  bool at_collision = false;
  std::optional<std::string> inspected = {};
  static auto state(auto& self) {
    return std::tie(self.time, self.meant, self.rounded, self.at_collision, self.inspected);
  }
};

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

  void begin_again() override;
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
  /// The observer comes before what records collisions, so that nothing of a collision is recorded if it throws.
  void observe(CollisionObserver observer) override;

  const Counts& counts() const override { return engine_->counts(); }
  Number time() const override { return time_.meant; }
  Number energy() const override { return engine_->state_at(time_, at_collision_)->state().energy; }
  std::vector<double> column(Column which) override { return now().column(which); }
  std::vector<std::string> column_text(Column which) override { return now().column_text(which); }
  const std::vector<ParticleIndex>& index() override { return now().index(); }

  void put_rows() override { measurements_.put_rows(engine_->counts(), sink_); }
  void save(StateSink& to) override;
  void load(StateSource& from) override;

  static auto state(auto& self) { return std::tie(self.measurements_, self.guards_); }

 private:
  // ---- how it advances
  std::unique_ptr<AnyEngine> engine();

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
  RunTime checked(const Decimal& until) const;

  const RunState& now() {
    if (!now_) now_ = engine_->state_at(time_, at_collision_);
    return *now_;
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
  bool sample_at(const Number& time);
  void notify_observer(const RunState& now, bool at_collision) {
    if (options_.observer != nullptr) options_.observer->sample(run_sample(scene_, plan_, *engine_, now, at_collision));
  }

  void end_with(Status status);
  void end_in_numbers(Status status);

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

}  // namespace cradle::tools
