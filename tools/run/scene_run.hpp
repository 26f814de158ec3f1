// A run on its way: the engine is advanced from one time that somebody wants to look at to the next, what is seen there
// is recorded, and in the end it becomes tables and texts.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cradle/core/observe/guards.hpp"
#include "cradle/tools/run/engine.hpp"
#include "cradle/tools/run/recorder.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/run_journal.hpp"
#include "cradle/tools/run/schedule.hpp"

namespace cradle::tools {

template <Real T> class SceneRun {
  static constexpr std::size_t most_rows = 1 << 14;              // that wait for a keeper
  static constexpr std::uint64_t contacts_between_guards = 256;  // of each body; half as many before the end
  static constexpr std::uint64_t most_guarded = 1 << 22;         // bodies: beyond, a look would double the memory

 public:
  SceneRun(const Scene& scene, std::shared_ptr<const cradle::Bodies<T>> bodies, Engine<T>& engine,
           const RunOptions& options, Progress& progress)
      : scene_(scene), options_(options), bodies_(std::move(bodies)), energy_(bodies_->kinetic_energy()),
        engine_(engine), progress_(progress), plan_(schedule<T>(scene)), contact_before_(number<T>(scene.run.start)) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
    if (scene.output.core) core_.emplace(bodies_, number<T>(scene.run.start));
  }

  RunOutcome operator()() {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    const auto also = [this](const Observer<T>& look) {
      observer_ = observer_ ? [before = observer_, look](const Contact<T>& c) { before(c), look(c); } : look;
    };
    if (scene_.output.events) also([this](const Contact<T>& c) { record_contact(c); });
    if (scene_.output.scenario)
      also([this](const Contact<T>& c) {
        scenario_.contact(c.left, c.right, to_double(T(c.time.value())), engine_.counts().merges);
      });
    if (options_.witness != nullptr)
      also([this](const Contact<T>& c) { options_.witness->contact(c.left, c.right, to_double(T(c.time.value()))); });
    if (options_.keeper != nullptr && options_.keeper->loaded_from() != nullptr) load(*options_.keeper->loaded_from());
    Status status = Status::reached;
    for (const T& stop : plan_.stops) {
      if (looked_ && !(*looked_ < stop)) continue;
      status = advance(stop);
      if (status != Status::reached) break;
      look(stop);
      progress_.tell(to_double(stop), engine_.counts().contacts);
    }
    const T end = status == Status::reached ? plan_.stops.back() : engine_.last_contact_time();
    const bool can_go_on = status == Status::reached || status == Status::interrupted;
    if (options_.keeper != nullptr && can_go_on) keep(end, true);
    if (!can_go_on || (options_.keeper == nullptr && status == Status::interrupted)) record_end(end);
    return finish(status, end);
  }

  // Beside the engine's state: what of the plan is done, and what observers have gathered.
  static auto state(auto& self) {
    return std::tie(self.looked_, self.snapshots_, self.profiles_, self.masses_, self.zone_, self.scenario_,
                    self.guarded_at_, self.contact_before_);
  }

  void loaded() const { require_state(zone_.has_value() == scene_.output.zone.from.has_value(), "zone"); }

 private:
  // ---- what is kept while the run goes on

  void load(StateReader& from) {
    if (from.text() != shape() || from.text() != precision_name(scene_.run))
      throw Error({}, "a checkpoint of another build or precision", "", "go on with the program that wrote it",
                  Exit::io);
    try {
      engine_.load(from);
      cradle::load(from, *this);
    } catch (const std::invalid_argument& error) {
      throw Error(std::string("the checkpoint cannot be gone on with: ") + error.what(), Exit::io);
    }
    from.end();
    // A state that is well formed may still be of no run, and would go on for ever.
    const auto [guarded_at, last] = std::pair(guarded_at_, engine_.last_contact_time());
    if (static_cast<std::uint64_t>(engine_.collided_bodies()) <= most_guarded)
      look_at_all(looked_ && last < *looked_ ? *looked_ : last);
    guarded_at_ = guarded_at;
    progress_.go_on_from(to_double(engine_.last_contact_time()), engine_.counts().contacts);
  }
  std::string shape() const { return engine_.shape() + state_shape<SceneRun>() + std::string(exact_part<T>); }

  // Rows that have been recorded go to the keeper, and now and then the state, which then follows from nothing else.
  void keep(const T& time, bool state_too) {
    put_rows();
    RunStatus now = seen_;
    now.time = to_double(time);
    now.contacts = engine_.counts().contacts;
    options_.keeper->keep(
        now,
        [this](StateWriter& to) {
          to.put(shape());
          to.put(precision_name(scene_.run));
          engine_.save(to);
          cradle::save(to, *this);
        },
        state_too);
  }
  void put_rows() {
    Columns<T> series = series_.take(scene_.walls.any());
    if (has_clouds(scene_)) append(series, cloud_.take());
    if (core_) append(series, core_->take());
    put(Recorded<T>{series_table(scene_), std::move(series), {}});
    if (has_clouds(scene_)) put(cloud_.take_heaviest());
    if (scene_.output.events) put(events_.take());
  }
  // Decimals only where somebody keeps them: ensembles and proofs have no use for them.
  void put(Recorded<T>&& rows) {
    for (Group& table : tables(std::move(rows), options_.keeper != nullptr)) put(std::move(table));
  }
  void put(Group&& rows) {
    if (options_.keeper != nullptr)
      options_.keeper->add(std::move(rows));
    else
      tables_.add(std::move(rows));
  }

  Status advance(const T& until) {
    const auto stopped = [this] { return options_.interrupt != nullptr && options_.interrupt->signal() != 0; };
    if (stopped()) return Status::interrupted;
    for (;;) {
      const Status status = engine_.advance(until, observer_);
      if (status != Status::interrupted || stopped()) return status;
      keep(engine_.last_contact_time(), false);
    }
  }

  // ---- what is recorded
  void look(const T& time) {
    if (holds(plan_.series, time)) record_sample(time);
    const bool snapshot = holds(plan_.snapshots, time), profiled = holds(plan_.profiles, time),
               masses = holds(plan_.masses, time), zone = holds(plan_.zone, time);
    if (snapshot || profiled || masses || zone) {
      const Configuration<T> now = engine_.configuration(time);
      if (snapshot) put(snapshot_rows(now, numbered("snapshots", snapshots_)));
      if (profiled) record_profile(now, time);
      if (masses) put(masses_table(now, bodies_->least_mass(), numbered("masses", masses_)));
      if (zone) zone_->add(now, *bodies_, T(time - number<T>(scene_.run.start)));
    }
    guard(time);
    looked_ = time;
    if (options_.witness != nullptr) tell_witness(time, false);
    if (options_.keeper == nullptr) return;
    options_.keeper->look();
    if (options_.keeper->due() || series_.rows() >= most_rows) keep(time, false);
  }
  // Looks at all bodies once in so many contacts of each, a hundredth of what these take, by the count of contacts and
  // not by the clock, so that a run that stops here does so always. Throws Error (Exit::lost).
  void guard(const T& time) {
    const std::uint64_t contacts = engine_.counts().contacts;
    const auto active = static_cast<std::uint64_t>(std::max<BodyIndex>(engine_.collided_bodies(), 16));
    const std::uint64_t between = contacts_between_guards / (time < plan_.stops.back() ? 1 : 2);
    const bool put_off = guarded_at_ > contacts && time < plan_.stops.back();
    const bool due = guarded_at_ > contacts ? contact_before_ < engine_.last_contact_time()  // the end is looked at
                                            : contacts >= guarded_at_ + between * active;
    if (!put_off && due && active <= most_guarded) look_at_all(time);
  }
  void look_at_all(const T& time) {
    const std::uint64_t contacts = engine_.counts().contacts;
    const Account<T>& account = engine_.account();
    const Configuration<T> now = engine_.configuration(time);
    const GuardLook<T> look =
        guarded(now, *bodies_, contacts, T(energy_ - engine_.energy_lost()), T(time - number<T>(scene_.run.start)),
                engine_.last_contact_time(), contact_before_, account.order_lost + account.unresolved == 0);
    if (look.broken) throw Error(guard_message(told(*look.broken, time)), Exit::lost);
    // A look goes over all bodies that have merged, too: the next one, but for that at the end, is put off by as many.
    const auto merged = static_cast<std::uint64_t>(now.to - now.from + 1) - now.x.size();
    guarded_at_ = contacts + contacts_between_guards * merged;
    contact_before_ = engine_.last_contact_time();
    seen_.gap_min = to_double(look.gap_min);
    seen_.closure_gap = to_double(look.closure_gap);
    seen_.closure_speed = to_double(look.closure_speed);
  }

  void record_contact(const Contact<T>& c) {
    events_(c);
    if (options_.keeper != nullptr && events_.rows() >= most_rows) put(events_.take());
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
    put(profile_table(profile(now, *bodies_, elapsed, range, wanted.bins), numbered("profiles", profiles_)));
  }

  void record_sample(const T& time) {
    const Sample<T> now = sample(engine_, energy_, time);
    series_.add(now);
    if (core_) core_->add(engine_.configuration(time), now.energy);
    if (!has_clouds(scene_)) return;
    const Cloud<T> seen = cloud(engine_.configuration(time));
    cloud_.add(seen);
    if (scene_.output.scenario)
      scenario_.look(seen, to_double(T(time - number<T>(scene_.run.start))), engine_.counts().merges);
  }

  void tell_witness(const T& time, bool at_contact) {
    const Sample<T> now = sample(engine_, energy_, time);
    options_.witness->look({to_double(time), to_text(time), holds(plan_.series, time), holds(plan_.snapshots, time),
                            at_contact, now.counts, to_text(now.energy),
                            now.front_right ? to_text(*now.front_right) : std::string()});
  }
  // A run that ends early leaves its last state.
  void record_end(const T& time) {
    if (options_.witness != nullptr) tell_witness(time, true);
    record_sample(time);
    put(snapshot_rows(engine_.configuration(time), numbered("snapshots", snapshots_)));
  }

  static std::string numbered(const char* folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

  RunOutcome finish(Status status, const T& time) {
    const Counts& counts = engine_.counts();
    RunOutcome end;
    end.end = end_of(status, engine_.account().order_lost > 0);
    end.contacts = counts.contacts;
    end.merges = counts.merges;
    end.time = to_double(time);
    end.energy = to_double(T(energy_ - engine_.energy_lost()));
    const ToldAccount account = told(engine_.account());
    end.warning = account_warning(account, scene_.run);
    if (status == Status::exhausted) end.warning += exhausted_warning(to_text(time), counts.contacts, scene_.run);
    end.result.attributes = provenance(scene_, precision_name(scene_.run), end_row(end.end).text);
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
    return end;
  }

  void put_tables(RunOutcome& end) {
    put_rows();
    std::vector<Group>& groups = end.result.groups;
    groups = std::move(tables_).in_order();
    // There also where there was no contact.
    if (scene_.output.events && options_.keeper != nullptr) append(groups, tables(events_.take(), true));
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
  }

  const Scene& scene_;
  const RunOptions& options_;
  std::shared_ptr<const cradle::Bodies<T>> bodies_;
  T energy_;
  Engine<T>& engine_;
  Progress& progress_;
  Schedule<T> plan_;
  std::optional<T> looked_;                                  // the last time looked at
  std::uint64_t snapshots_ = 0, profiles_ = 0, masses_ = 0;  // tables written
  SeriesRecorder<T> series_;
  CloudRecorder<T> cloud_;
  std::optional<ZoneAverage> zone_;
  std::optional<CoreRecorder<T>> core_;
  ScenarioWatch scenario_;
  EventRecorder<T> events_;
  Observer<T> observer_;
  std::uint64_t guarded_at_ = 0;  // contacts made, at the last look at all bodies, and the time of the last of them
  T contact_before_;
  RunStatus seen_;        // then
  GrowingTables tables_;  // where there is no keeper
};

}  // namespace cradle::tools
