// A run on its way: the engine is advanced from one time that somebody wants to look at to the next, what is seen there
// is recorded, and in the end it becomes tables and texts.
#pragma once

#include <cmath>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cradle/core/observe/trace.hpp"
#include "cradle/tools/run/engine.hpp"
#include "cradle/tools/run/recorder.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/schedule.hpp"

namespace cradle::tools {

template <Real T> class SceneRun {
 public:
  SceneRun(const Scene& scene, std::shared_ptr<const cradle::Bodies<T>> bodies, Engine<T>& engine,
           const RunOptions& options, Progress& progress)
      : scene_(scene), options_(options), bodies_(std::move(bodies)), energy_(bodies_->kinetic_energy()),
        engine_(engine), progress_(progress), plan_(schedule<T>(scene)) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
  }

  RunOutcome operator()() {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    if (scene_.output.events) observer_ = [this](const Contact<T>& c) { events_(c); };
    if (scene_.output.scenario)
      observer_ = [this, record = std::move(observer_)](const Contact<T>& c) {
        if (record) record(c);
        scenario_.contact(c.left, c.right, to_double(T(c.time.value())), engine_.counts().merges);
      };
    if (options_.trace) observer_ = [this](const Contact<T>& c) { trace_.contact(c.left, c.right); };
    Status status = Status::reached;
    for (const T& stop : plan_.stops) {
      status = advance(stop);
      if (status != Status::reached) break;
      look(stop);
      progress_.tell(to_double(stop), engine_.counts().contacts);
    }
    if (status == Status::reached) return finish(status, plan_.stops.back());
    const T end = engine_.last_contact_time();
    record_end(end);
    return finish(status, end);
  }

 private:
  static bool take(const std::vector<T>& times, std::size_t& next, const T& time) {
    if (next >= times.size() || times[next] != time) return false;
    ++next;
    return true;
  }

  Status advance(const T& until) {
    const Status status = engine_.advance(until, observer_);
    if (engine_.makes_contacts()) return status;  // these ask for signals themselves
    return options_.interrupt != nullptr && options_.interrupt->signal() != 0 ? Status::interrupted : status;
  }

  void look(const T& time) {
    if (take(plan_.series, next_series_, time)) record_sample(time);
    const bool snapshot = take(plan_.snapshots, next_snapshot_, time),
               profiled = take(plan_.profiles, next_profile_, time), masses = take(plan_.masses, next_masses_, time),
               zone = take(plan_.zone, next_zone_, time);
    if (!snapshot && !profiled && !masses && !zone) return;
    const Configuration<T> now = engine_.configuration(time);
    if (snapshot) snapshots_.push_back(snapshot_table(now, numbered("snapshots", snapshots_.size())));
    if (profiled) record_profile(now, time);
    if (masses) masses_.push_back(masses_table(now, bodies_->least_mass(), numbered("masses", masses_.size())));
    if (zone) zone_->add(now, *bodies_, T(time - number<T>(scene_.run.start)));
  }

  void record_profile(const Configuration<T>& now, const T& time) {
    const auto& wanted = scene_.output.profiles;
    const T elapsed = time - number<T>(scene_.run.start);
    BinRange range{to_double(now.x.front()), to_double(now.x.back())};
    if (!wanted.range.empty())
      range = {wanted.range[0].value, wanted.range[1].value};
    else if (engine_.collided_bodies() > 0 && !engine_.on_ring())
      range = {to_double(engine_.front_left(time)), to_double(engine_.front_right(time))};
    if (!(range.from < range.to)) range.to = range.from + 1;  // all in one place: one length around it
    profiles_.push_back(
        profile_table(profile(now, *bodies_, elapsed, range, wanted.bins), numbered("profiles", profiles_.size())));
  }

  void record_sample(const T& time) {
    const Sample<T> now = sample(engine_, energy_, time);
    series_.add(now);
    if (has_clouds(scene_)) {
      const Cloud<T> seen = cloud(engine_.configuration(time));
      cloud_.add(seen);
      if (scene_.output.scenario)
        scenario_.look(seen, to_double(T(time - number<T>(scene_.run.start))), engine_.counts().merges);
    }
    if (options_.trace)
      trace_samples_.push_back({to_double(time), trace_.digest(), now.counts.contacts, now.counts.merges,
                                to_text(now.energy), now.front_right ? to_text(*now.front_right) : std::string()});
  }

  // A run that ends early leaves its last state.
  void record_end(const T& time) {
    record_sample(time);
    snapshots_.push_back(snapshot_table(engine_.configuration(time), numbered("snapshots", snapshots_.size())));
  }

  static std::string numbered(const char* folder, std::size_t number) {
    return fmt::format("{}/{:04}", folder, number);
  }

  RunOutcome finish(Status status, const T& time) {
    const Counts& counts = engine_.counts();
    RunOutcome end;
    end.end = end_of(status);
    end.contacts = counts.contacts;
    end.merges = counts.merges;
    end.time = to_double(time);
    end.energy = to_double(T(energy_ - engine_.energy_lost()));
    const ToldAccount account = told(engine_.account());
    end.warning = account_warning(account, scene_.run);
    if (status == Status::exhausted) end.warning += exhausted_warning(to_text(time), counts.contacts, scene_.run);
    end.result.attributes = provenance(scene_, precision_name(scene_.run), end_text(end.end));
    for (const Attribute& attribute :
         {Attribute("simultaneous_contacts", account.simultaneous), Attribute("order_lost", account.order_lost),
          Attribute("unresolved_gaps", account.unresolved)})
      end.result.attributes.push_back(attribute);
    put_tables(end);
    if (status == Status::collapsed) {
      const ToldCollapse collapse = told(*engine_.collapse());
      end.report = collapse_report(collapse, counts.contacts);
      end.collapse_time = collapse.time.digits;
      end.result.groups.push_back(collapse_table(collapse));
    }
    end.trace = std::move(trace_samples_);
    return end;
  }

  RunEnd end_of(Status status) const {
    switch (status) {
    case Status::reached:
      break;
    case Status::collapsed:
      return RunEnd::collapsed;
    case Status::exhausted:
      return RunEnd::exhausted;
    case Status::interrupted:
      return RunEnd::interrupted;
    }
    return engine_.account().order_lost > 0 ? RunEnd::order_lost : RunEnd::reached;
  }

  void put_tables(RunOutcome& end) {
    std::vector<Group>& groups = end.result.groups;
    if (has_clouds(scene_))
      groups = std::move(cloud_).tables(std::move(series_));
    else
      groups.push_back(std::move(series_).table());
    for (auto* tables : {&snapshots_, &profiles_, &masses_})
      for (auto& table : *tables) groups.push_back(std::move(table));
    if (zone_) {
      const double single = 2 * std::sqrt(scene_.law.loss.value);  // u_crit of single bodies
      const ZoneWidth width = zone_->width(scene_.initial.speed.value, single);
      groups.push_back(zone_result(*zone_, width, scene_));
      end.summary.emplace_back("zone_width", width.width);
    }
    if (scene_.output.scenario) {
      const auto numbers = scenario_numbers(scenario_.result(engine_.counts().merges));
      groups.push_back({"scenario", {numbers.begin(), numbers.end()}, {}});
      end.summary.insert(end.summary.end(), numbers.begin(), numbers.end());
    }
    if (scene_.output.events) groups.push_back(std::move(events_).table());
  }

  const Scene& scene_;
  const RunOptions& options_;
  std::shared_ptr<const cradle::Bodies<T>> bodies_;
  T energy_;
  Engine<T>& engine_;
  Progress& progress_;
  Schedule<T> plan_;
  std::size_t next_series_ = 0, next_snapshot_ = 0, next_profile_ = 0, next_masses_ = 0, next_zone_ = 0;
  SeriesRecorder<T> series_;
  CloudRecorder<T> cloud_;
  std::optional<ZoneAverage> zone_;
  ScenarioWatch scenario_;
  EventRecorder<T> events_;
  Trace trace_;
  std::vector<TraceSample> trace_samples_;
  Observer<T> observer_;
  std::vector<Group> snapshots_, profiles_, masses_;
};

}  // namespace cradle::tools
