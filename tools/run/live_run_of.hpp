// A run that its caller holds (live_run.hpp), in one scalar type: the engine and the recorders of `cradle run`, with a
// store in memory.
#pragma once

#include <array>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/run/live_run.hpp"
#include "cradle/tools/run/memory_store.hpp"
#include "cradle/tools/run/run_in.hpp"
#include "cradle/tools/support/threads.hpp"

namespace cradle::tools {

template <Real T> class LiveRunOf final : public LiveRun {
 public:
  LiveRunOf(const Scene& scene, const LiveOptions& options, StateSource* from)
      : scene_(scene), restitution_(options.restitution), threads_(thread_count(options.threads)),
        store_(options.poll), options_{Progress::Show::never, nullptr, nullptr, workers_of_calls(), &store_, false},
        progress_(Progress::Show::never, scene.run.start.value, scene.run.until.value, false),
        particles_(initial_particles<T>(scene_)), engine_(engine()),
        run_(scene_, particles_, *engine_, options_, progress_),
        time_(number<T>(scene_.run.start), scene_.run.start.text), end_(number<T>(scene_.run.until)) {
    run_.observe();
    if (from == nullptr) return;
    std::vector<Group> rows;
    try {
      cradle::load(*from, rows);
      T time{0};
      std::string meant;
      cradle::load(*from, time);
      cradle::load(*from, meant);
      cradle::load(*from, at_collision_);
      time_ = Given<T>(time, meant);
    } catch (const std::invalid_argument& error) {
      throw Error(std::string("the checkpoint cannot be extended: ") + error.what(), Exit::io);
    }
    for (Group& table : rows) store_.add(std::move(table));
    run_.load(*from);
  }

  const Scene& scene() const override { return scene_; }

  void advance(const Decimal& until) override {
    const Given<T> time = checked(until);
    computing([&] {
      stand(run_.pass(time.value, [&](const T& to) { return engine_->advance(to, run_.observer()); }), time);
    });
  }
  std::uint64_t step(std::uint64_t n, const Decimal& until) override {
    const Given<T> time = checked(until);
    if (n > 0)
      computing([&] {
        const Status status = run_.pass(time.value, [&](const T& to) {
          const Status made = engine_->step(n, to, run_.observer());
          return made == Status::reached && n == 0 ? Status::interrupted : made;
        });
        status == Status::interrupted ? stand_at_last_collision() : stand(status, time);
      });
    return n;
  }
  void stop() override {
    require_in_progress();
    if (failed_) throw *failed_;
    over_ = run_.end_with(Status::interrupted);
  }
  void observe(std::function<void(const LiveCollision&)> observer) override {
    if (!observer) return run_.observe();
    run_.observe([observer = std::move(observer)](const Collision<T>& c) {
      observer({c.left, c.right, to_double(T(c.time.value())), to_double(c.interval), to_double(c.closing_speed)});
    });
  }

  const RunOutcome* over() const override { return over_ ? &*over_ : nullptr; }
  const Counts& counts() const override { return engine_->counts(); }
  double time() const override { return time_.rounded; }
  std::string time_text() const override { return time_.text; }
  double energy() const override { return to_double(run_.energy_at(time_.value)); }
  std::string energy_text() const override { return to_text(run_.energy_at(time_.value)); }
  std::vector<double> column(Column which) override {
    return made_of<double>(which, [](const T& number) { return to_double(number); });
  }
  std::vector<std::string> column_text(Column which) override {
    return made_of<std::string>(which, [](const T& number) { return to_text(number); });
  }
  const std::vector<ParticleIndex>& index() override { return now().index; }

  void save(StateSink& to) override {
    require_own_law("saved");
    require_in_progress();
    run_.put_rows();
    cradle::save(to, store_.tables());
    cradle::save(to, time_.value);
    cradle::save(to, time_.text);
    cradle::save(to, at_collision_);
    run_.save(to);
  }
  void require_result() const override {
    require_own_law("written");
    if (!over_)
      throw Error({scene_.name, 0, ""}, "not at its end", "t = " + time_.text,
                  "advance to run.until = " + scene_.run.until.text +
                      " first, stop the run here, or save a checkpoint");
  }
  Result result() override {
    require_result();
    if (over_->end == RunEnd::interrupted || !without_collisions(scene_)) return store_.result(over_->result);
    MemoryStore store({});
    const RunOutcome direct = run_scene(scene_, {Progress::Show::never, nullptr, nullptr, {}, &store, false});
    return store.result(direct.result);
  }

 private:
  std::unique_ptr<Engine<T>> engine() {
    const Policy<T> policy = policy_of<T>(scene_, options_, progress_);
    if constexpr (std::same_as<T, double>) {
      if (restitution_) return engine_with(restitution_, scene_, particles_, policy);
    } else if (restitution_) {
      throw Error({scene_.name, 0, "run.precision"}, "a restitution that is a function is of type double",
                  precision_name(scene_.run), "give run.precision = \"double\"");
    }
    return engine_of<T>(scene_, particles_, policy, options_.workers, true);
  }
  // Threads are there only during a call: an idle run does not limit what other code uses of them.
  Workers workers_of_calls() {
    if (threads_ < 2) return {};
    return {threads_, [this](std::size_t jobs, const Workers::Work& work) { for_each(*executor_, jobs, work); }};
  }

  template <class F> void computing(const F& f) {
    if (failed_) throw *failed_;
    now_.reset();
    if (threads_ > 1) executor_.emplace(threads_);
    try {
      f();
    } catch (const Error& error) {  // not of a caller's function: the run has failed
      failed_ = error;
      executor_.reset();
      throw;
    } catch (...) {
      stand_at_last_collision();
      executor_.reset();
      throw;
    }
    executor_.reset();
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
    if (status != Status::reached || !(time.value < end_)) over_ = run_.end_with(status);
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
  void require_own_law(const char* what) const {
    if (restitution_)
      throw Error({scene_.name, 0, "restitution"}, std::string("a function cannot be ") + what, "",
                  "collect its numbers in Python (every, on_collision)");
  }

  Scene scene_;
  std::function<double(double)> restitution_;
  unsigned threads_;
  std::optional<Threads> executor_;
  MemoryStore store_;
  RunOptions options_;
  Progress progress_;
  std::shared_ptr<const cradle::Particles<T>> particles_;
  std::unique_ptr<Engine<T>> engine_;
  SceneRun<T> run_;
  Given<T> time_;
  T end_;
  bool at_collision_ = false;  // the state is the one right after the last collision
  std::optional<Configuration<T>> now_;
  std::optional<RunOutcome> over_;
  std::optional<Error> failed_;
};

template <class T> std::unique_ptr<LiveRun> live_in(const Scene& scene, const LiveOptions& options, StateSource* from) {
  return std::make_unique<LiveRunOf<T>>(scene, options, from);
}

}  // namespace cradle::tools
