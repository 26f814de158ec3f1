#pragma once
// What a run records at its output times and at collisions, and when it gives rows and its state to the store.

#include "cradle/tools/run/scene_run_in.hpp"

namespace cradle::tools {

// Returns false if a signal has stopped a loop over rows, which can be very long; then nothing of this time is
// recorded yet.
template <Real T> inline bool SceneRunIn<T>::sample_at(const T& time) {
  const bool snapshot = plan_.snapshots.hold(time), profiled = plan_.profiles.hold(time),
             masses = plan_.masses.hold(time), zone = plan_.zone.hold(time), averaged = plan_.averages.hold(time),
             counted = plan_.counting.hold(time), correlated = correlations_ && correlations_->due(time);
  std::optional<Configuration<T>> now;
  std::optional<Profile> seen;
  if (snapshot || profiled || masses || zone || averaged || counted || correlated) now = engine_->configuration(time);
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
  if (correlated) correlations_->add(time, [this](Group&& table) { sink_.add(std::move(table)); });
  const Given<T> meant = plan_.meant(time);
  if (plan_.series.hold(time)) record_sample(meant);
  if (snapshot) put(snapshot_rows(*now, meant, numbered("snapshots", snapshots_)));
  if (seen) seen->time = meant.rounded, sink_.add(profile_table(std::move(*seen), numbered("profiles", profiles_)));
  if (masses) sink_.add(masses_table(*now, meant.rounded, particles_->least_mass(), numbered("masses", masses_)));
  guards_.check(time, !(time < plan_.stops.back()));
  inspected_ = time;
  if (options_.observer != nullptr) notify_observer(time, false);
  sink_.check_clock();
  if (sink_.due())
    keep(time);
  else if (series_.rows() >= most_rows)
    put_rows();
  return true;
}

template <Real T> inline void SceneRunIn<T>::observe(std::function<void(const HeldCollision&)> observer) {
  observer_ = {};
  const auto also = [this](const Observer<T>& added) {
    observer_ = observer_ ? [before = observer_, added](const Collision<T>& c) { before(c), added(c); } : added;
  };
  if (observer)
    also([observer = std::move(observer)](const Collision<T>& c) {
      observer({c.left, c.right, to_double(T(c.time.value())), to_double(c.interval), to_double(c.closing_speed)});
    });
  if (scene_.output.events) also([this](const Collision<T>& c) { record_collision(c); });
  if (word_) also([this](const Collision<T>& c) { word_->add(c.left, to_double(T(c.time.value()))); });
  if (histograms_ && scene_.output.observes_collisions())
    also([this](const Collision<T>& c) { histograms_->made(engine_->counts()), (*histograms_)(c); });
  if (scene_.output.scenario)
    also([this](const Collision<T>& c) {
      scenario_.collision(c.left, c.right, to_double(T(c.time.value())), engine_->counts().merges);
    });
  if (options_.observer != nullptr)
    also(
        [this](const Collision<T>& c) { options_.observer->collision(c.left, c.right, to_double(T(c.time.value()))); });
}

template <Real T> inline void SceneRunIn<T>::record_collision(const Collision<T>& c) {
  events_.made(engine_->counts());
  if (events_.rows() >= most_rows) put(events_.take());
  events_(c);
}

template <Real T> inline Profile SceneRunIn<T>::profile_at(const Configuration<T>& now, const T& time) const {
  const auto& wanted = scene_.output.profiles;
  const T elapsed = time - number<T>(scene_.run.start);
  BinRange range{to_double(now.x.front()), to_double(now.x.back())};
  if (!wanted.range.empty())
    range = {wanted.range[0].value, wanted.range[1].value};
  else if (engine_->on_ring())
    range = {0, to_double(particles_->circumference())};
  else if (engine_->collided_particles() > 0)
    range = {to_double(engine_->front_left(time)), to_double(engine_->front_right(time))};
  if (!(range.from < range.to)) range.to = range.from + 1;  // all particles at one place: the range has length 1
  if (!std::isfinite(range.to - range.from))
    throw Error({scene_.name, 0, "output.profiles.range"}, "not given, and the particles are where no double reaches",
                to_text(time), "give it, or remove output.profiles", Exit::lost);
  return profile(now, *particles_, elapsed, range, wanted.bins, [this] { return stopped(); });
}

template <Real T> inline void SceneRunIn<T>::record_sample(const Given<T>& at) {
  const T& time = at.value;
  const Moment<T> now(*engine_, particles_, number<T>(scene_.run.start), at);
  guards_.require_held(now.state.energy, "the energy", time);
  for (const auto& front : {now.state.front_left, now.state.front_right})
    if (front) guards_.require_held(*front, "a front", time);
  series_.add(now);
  if (!has_clouds(scene_)) return;
  heaviest_.add(now.cloud());
  if (scene_.output.scenario)
    scenario_.sample(now.cloud(), to_double(T(time - number<T>(scene_.run.start))), engine_->counts().merges);
}

}  // namespace cradle::tools
