#include "cradle/tools/run/engine_run.hpp"
#include "cradle/tools/run/report.hpp"

namespace cradle::tools {

void EngineRun::begin_again() {
  engine_->begin_again();
  measurements_.begin_again();
  guards_.begin_again();
  observe({});  // the counts of another engine
  inspected_.reset(), now_.reset(), failed_.reset(), over_.reset();
  time_ = start_, at_collision_ = false;
}

void EngineRun::save(StateSink& to) {
  require_in_progress();
  cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
  engine_->save(to);
  const auto inspected = inspected_ ? std::optional(inspected_->text()) : std::nullopt;
  cradle::save(to, SavedTimes{time_.exact.text(), time_.meant.text(), time_.meant.value, at_collision_, inspected});
  cradle::save(to, *this);
}

void EngineRun::load(StateSource& from) {
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

std::unique_ptr<AnyEngine> EngineRun::engine() {
  return begin_engine(scene_,
                      {.interrupt = [this] { return stopped() || sink_.due(); },
                       .progress =
                           [this](double time, const Counts& counts) {
                             progress_.report(time, counts.collisions);
                             sink_.count(counts.collisions);
                           },
                       .workers = options_.workers,
                       .observed = scene_.output.observes_collisions() || options_.observer != nullptr || options_.held,
                       .restitution = options_.restitution});
}

bool EngineRun::sample_at(const Number& time) {
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
  if (sink_.due())
    keep(time);
  else if (measurements_.many_rows())
    put_rows();
  if (sink_.for_statistics()) now_ = std::move(state);
  return true;
}

// Of a run for statistics.
void EngineRun::end_in_numbers(Status status) {
  const bool reached = status == Status::reached;  // with a sample at the end
  if (!reached) now_ = engine_->state_at(engine_->last_collision_time());
  const RunState& now = *now_;
  if (!reached) {
    guards_.require_between_walls(now);
    guards_.require_held(now, false);
    measurements_.record_last(now, sink_);
  }
  put_rows();
  over_ = outcome_of(scene_, *engine_, now, status);
  over_->summary = measurements_.finish(now, sink_);
}

void EngineRun::end_with(Status status) {
  if (sink_.for_statistics()) return end_in_numbers(status);
  const bool reached = status == Status::reached, interrupted = status == Status::interrupted;
  const Number end = reached ? plan_.last() : engine_->last_collision_time();
  if (reached || interrupted) keep(end, reached ? RunIs::over : RunIs::interrupted);
  const std::unique_ptr<RunState> state = engine_->state_at(reached ? plan_.meant(end) : RunTime(end));
  const RunState& now = *state;
  if (!reached && !(interrupted && sink_.for_file())) {  // its last state
    guards_.require_between_walls(now);
    notify_observer(now, true);
    guards_.require_held(now, false);
    measurements_.record_last(now, sink_);
  }
  RunEnding ending(scene_, *engine_, now, status);
  put_rows();
  ending.outcome.summary = measurements_.finish(now, sink_);
  for (Group& table : ending.collapse) sink_.add(std::move(table));
  ending.outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  std::vector<Attribute> attributes;
  if (sink_.for_file()) attributes = provenance(scene_, precision_name(scene_.run), end_row(ending.outcome.end).text);
  append(attributes, std::move(ending.attributes));
  sink_.end(std::move(attributes), ending.outcome.end);
  over_ = std::move(ending.outcome);
}

void EngineRun::observe(CollisionObserver observer) {
  observer_ = {};
  const auto also = [this](CollisionObserver added) {
    observer_ =
        observer_ ? [before = observer_, added](const ObservedCollision& c) { before(c), added(c); } : std::move(added);
  };
  if (observer) also(std::move(observer));
  measurements_.observe(engine_->counts(), sink_, also);
  if (options_.observer != nullptr)
    also([this](const ObservedCollision& c) { options_.observer->collision(c.left, c.right, c.time); });
}

RunTime EngineRun::checked(const Decimal& until) const {
  require_in_progress();
  if (until.text == scene_.run.until.text) return end_;
  const RunTime time(round_(until.text), until.text);
  if (time.exact < time_.exact)
    throw Error({scene_.name, 0, ""}, "a time in the past", until.text,
                "the run is at t = " + time_.meant.text() + " and goes forward only");
  if (end_.exact < time.exact)
    throw Error({scene_.name, 0, ""}, "a time after the end", until.text,
                "the end is run.until = " + scene_.run.until.text);
  return time;
}

void SceneRun::require_in_progress() const {
  if (over_)
    throw Error({scene_.name, 0, ""}, "the run is over",
                std::string(end_row(over_->end).text) + " at t = " + time().text(),
                "write its result, or begin another one");
}

std::unique_ptr<SceneRun> begin_run(const Scene& scene, const RunOptions& options, Sink& sink) {
  check_built(scene);
  if (scene.initial.type == InitialType::clusters)
    throw Error(scene.place("initial.type"), "a model without particles", "clusters", "use `cradle run`");
  return std::make_unique<EngineRun>(scene, options, sink);
}

}  // namespace cradle::tools
