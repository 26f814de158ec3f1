// A run in progress: the engine is advanced from one output time to the next, its state is recorded there, and in the
// end the records become tables and texts.
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
#include "cradle/tools/record/columns.hpp"
#include "cradle/tools/record/recorder.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/run/engine.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/run_journal.hpp"

namespace cradle::tools {

template <Real T> class SceneRun {
  static constexpr std::size_t most_rows = 1 << 14;                // that wait for a keeper
  static constexpr std::uint64_t collisions_between_guards = 256;  // of each particle; half as many before the end
  static constexpr std::uint64_t most_guarded = 1 << 22;           // particles: beyond, a check would double the memory

 public:
  SceneRun(const Scene& scene, std::shared_ptr<const cradle::Particles<T>> particles, Engine<T>& engine,
           const RunOptions& options, Progress& progress)
      : scene_(scene), options_(options), particles_(std::move(particles)), energy_(particles_->kinetic_energy()),
        engine_(engine), progress_(progress), plan_(schedule<T>(scene)), series_(scene),
        collision_before_(number<T>(scene.run.start)) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
  }

  RunOutcome operator()() {
    if (options_.interrupt != nullptr) options_.interrupt->heed();
    const auto also = [this](const Observer<T>& added) {
      observer_ = observer_ ? [before = observer_, added](const Collision<T>& c) { before(c), added(c); } : added;
    };
    if (scene_.output.events) also([this](const Collision<T>& c) { record_collision(c); });
    if (scene_.output.scenario)
      also([this](const Collision<T>& c) {
        scenario_.collision(c.left, c.right, to_double(T(c.time.value())), engine_.counts().merges);
      });
    if (options_.observer != nullptr)
      also([this](const Collision<T>& c) {
        options_.observer->collision(c.left, c.right, to_double(T(c.time.value())));
      });
    if (options_.store != nullptr && options_.store->loaded_from() != nullptr) load(*options_.store->loaded_from());
    Status status = Status::reached;
    for (const T& stop : plan_.stops) {
      if (inspected_ && !(*inspected_ < stop)) continue;
      status = advance(stop);
      if (status == Status::reached && !sample_at(stop)) status = Status::interrupted;
      if (status != Status::reached) break;
      progress_.report(to_double(stop), engine_.counts().collisions);
    }
    const T end = status == Status::reached ? plan_.stops.back() : engine_.last_collision_time();
    const bool can_continue = status == Status::reached || status == Status::interrupted;
    if (options_.store != nullptr && can_continue)
      keep(end, status == Status::reached ? RunIs::over : RunIs::interrupted);
    if (!can_continue || (options_.store == nullptr && status == Status::interrupted)) record_end(end);
    return finish(status, end);
  }

  // Beside the engine's state: what of the plan is done, and what observers have gathered.
  static auto state(auto& self) {
    return std::tie(self.inspected_, self.snapshots_, self.profiles_, self.masses_, self.zone_, self.scenario_,
                    self.guarded_at_, self.collision_before_);
  }

  void loaded() const { require_state(zone_.has_value() == scene_.output.zone.from.has_value(), "zone"); }

 private:
  // ---- what is kept during the run

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
    // A state that is well formed may still be of no run, and would run for ever.
    const auto [guarded_at, last] = std::pair(guarded_at_, engine_.last_collision_time());
    if (static_cast<std::uint64_t>(engine_.collided_particles()) <= most_guarded)
      inspect_all(inspected_ && last < *inspected_ ? *inspected_ : last);
    guarded_at_ = guarded_at;
    progress_.continue_from(to_double(engine_.last_collision_time()), engine_.counts().collisions);
  }
  std::string shape() const { return engine_.shape() + state_shape<SceneRun>() + std::string(exact_part<T>); }

  // Rows that have been recorded go to the keeper, and now and then the state, which then follows from nothing else.
  void keep(const T& time, RunIs run_is = RunIs::in_progress) {
    put_rows();
    RunStatus now = status_;
    now.time = to_double(time);
    now.collisions = engine_.counts().collisions;
    options_.store->keep(
        now,
        [this](StateWriter& to) {
          cradle::save(to, std::pair(shape(), precision_name(scene_.run)));
          engine_.save(to);
          cradle::save(to, *this);
        },
        run_is);
  }
  void put_rows() {
    put(series_.take());
    if (has_clouds(scene_)) put(heaviest_.take());
    if (scene_.output.events) put(events_.take());
  }
  // Decimals only where somebody keeps them: ensembles and proofs have no use for them.
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
  // False where a signal has stopped a walk over rows that can be longer than anybody waits for: then nothing of this
  // time is recorded yet.
  bool sample_at(const T& time) {
    const bool snapshot = holds(plan_.snapshots, time), profiled = holds(plan_.profiles, time),
               masses = holds(plan_.masses, time), zone = holds(plan_.zone, time);
    std::optional<Configuration<T>> now;
    std::optional<Profile> seen;
    if (snapshot || profiled || masses || zone) now = engine_.configuration(time);
    if (now) require_held(*now);
    try {
      if (profiled) seen = profile_at(*now, time);
      if (zone) zone_->add(*now, *particles_, T(time - number<T>(scene_.run.start)), [this] { return stopped(); });
    } catch (const WalkStopped&) {
      return false;
    }
    if (holds(plan_.series, time)) record_sample(time);
    if (snapshot) put(snapshot_rows(*now, numbered("snapshots", snapshots_)));
    if (seen) put(profile_table(std::move(*seen), numbered("profiles", profiles_)));
    if (masses) put(masses_table(*now, particles_->least_mass(), numbered("masses", masses_)));
    guard(time);
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
  // Checks all particles once in so many collisions of each, a hundredth of what these take, by the count of collisions
  // and not by the clock, so that a run that stops here does so always. Throws Error (Exit::lost).
  void guard(const T& time) {
    const std::uint64_t collisions = engine_.counts().collisions;
    const auto active = static_cast<std::uint64_t>(std::max<ParticleIndex>(engine_.collided_particles(), 16));
    const std::uint64_t between = collisions_between_guards / (time < plan_.stops.back() ? 1 : 2);
    const bool put_off = guarded_at_ > collisions && time < plan_.stops.back();
    const bool due = guarded_at_ > collisions ? collision_before_ < engine_.last_collision_time()  // the end is checked
                                              : collisions >= guarded_at_ + between * active;
    if (!put_off && due && active <= most_guarded) inspect_all(time);
  }
  void inspect_all(const T& time) {
    const std::uint64_t collisions = engine_.counts().collisions;
    const Account<T>& account = engine_.account();
    const Configuration<T> now = engine_.configuration(time);
    const GuardCheck<T> check =
        guarded(now, *particles_, collisions, T(energy_ - engine_.energy_lost()), T(time - number<T>(scene_.run.start)),
                engine_.last_collision_time(), collision_before_, account.order_lost + account.unresolved == 0);
    if (check.broken) throw Error(guard_message(reported(*check.broken, time)), Exit::lost);
    // A check visits all particles that have merged, too: the next one, but for that at the end, is put off by as many.
    const auto merged = static_cast<std::uint64_t>(now.to - now.from + 1) - now.x.size();
    guarded_at_ = collisions + collisions_between_guards * merged;
    collision_before_ = engine_.last_collision_time();
    status_.gap_min = to_double(check.gap_min);
    status_.closure_gap = to_double(check.closure_gap);
    status_.closure_speed = to_double(check.closure_speed);
  }

  void record_collision(const Collision<T>& c) {
    events_(c);
    if (options_.store != nullptr && events_.rows() >= most_rows) put(events_.take());
  }
  Profile profile_at(const Configuration<T>& now, const T& time) const {
    const auto& wanted = scene_.output.profiles;
    const T elapsed = time - number<T>(scene_.run.start);
    BinRange range{to_double(now.x.front()), to_double(now.x.back())};
    if (!wanted.range.empty())
      range = {wanted.range[0].value, wanted.range[1].value};
    else if (engine_.collided_particles() > 0 && !engine_.on_ring())
      range = {to_double(engine_.front_left(time)), to_double(engine_.front_right(time))};
    if (!(range.from < range.to)) range.to = range.from + 1;  // all in one place: one length around it
    if (!std::isfinite(range.to - range.from))
      throw Error({scene_.name, 0, "output.profiles.range"}, "not given, and the particles are where no double reaches",
                  to_text(time), "give it, or remove output.profiles", Exit::lost);
    return profile(now, *particles_, elapsed, range, wanted.bins, [this] { return stopped(); });
  }
  // What follows from a number beyond the type's range is noise. Throws Error (Exit::lost).
  void require_held(const T& number, const char* what, const T& time) const {
    if (is_finite(number)) return;
    throw Error({scene_.name, 0, ""}, fmt::format("{} beyond the range of {}", what, precision_name(scene_.run)),
                "at t = " + to_text(time), "give an earlier run.until, smaller speeds or a wider run.precision",
                Exit::lost);
  }
  void require_held(const Configuration<T>& now) const {
    for (const T& x : now.x) require_held(x, "a position", now.time);
    for (const T& v : now.v) require_held(v, "a velocity", now.time);
  }

  void record_sample(const T& time) {
    const Moment<T> now(engine_, particles_, number<T>(scene_.run.start), time);
    require_held(now.state.energy, "the energy", time);
    for (const auto& front : {now.state.front_left, now.state.front_right})
      if (front) require_held(*front, "a front", time);
    series_.add(now);
    if (!has_clouds(scene_)) return;
    heaviest_.add(now.cloud());
    if (scene_.output.scenario)
      scenario_.sample(now.cloud(), to_double(T(time - number<T>(scene_.run.start))), engine_.counts().merges);
  }

  void notify_observer(const T& time, bool at_collision) {
    const Sample<T> now = sample(engine_, energy_, time);
    const auto text = [](const std::optional<T>& x) { return x ? to_text(*x) : std::string(); };
    RunSample at_time{.time = to_double(time),
                      .time_text = to_text(time),
                      .epsilon = from_text<long double>(to_text(T(std::numeric_limits<T>::epsilon()))),
                      .requested = at_collision ? std::vector{RequestedTime{Decimal(to_text(time)), true, false, true}}
                                                : requested_times(scene_, plan_, time),
                      .of_series = holds(plan_.series, time),
                      .at_collision = at_collision,
                      .counts = now.counts,
                      .energy = to_text(now.energy),
                      .front_left = text(now.front_left),
                      .front_right = text(now.front_right),
                      .particles = {}};
    if (!at_collision && holds(plan_.snapshots, time)) at_time.particles = sampled(engine_.configuration(time));
    options_.observer->sample(at_time);
  }
  static SampledParticles sampled(const Configuration<T>& c) {
    const auto texts = [](const std::vector<T>& numbers) {
      std::vector<std::string> all;
      for (const T& number : numbers) all.push_back(to_text(number));
      return all;
    };
    return {c.from, c.to, c.index, texts(c.x), texts(c.v), texts(c.m)};
  }
  // A run that ends early leaves its last state.
  void record_end(const T& time) {
    if (options_.observer != nullptr) notify_observer(time, true);
    record_sample(time);
    put(snapshot_rows(engine_.configuration_at_last_collision(), numbered("snapshots", snapshots_)));
  }

  static std::string numbered(const char* folder, std::uint64_t& n) { return fmt::format("{}/{:04}", folder, n++); }

  // Digits that rounding leaves in the energy at the end, about. C collisions of N particles round a speed by eps each
  // time, by eps sqrt(1 + C/N) in all, and the energy by twice that: of what they are then where closing speeds are
  // held, of what they were at the start where velocities are.
  double energy_digits(double energy) const {
    const auto active = static_cast<double>(std::max<ParticleIndex>(engine_.collided_particles(), 1));
    const double epsilon = to_double(T(std::numeric_limits<T>::epsilon()));  // 0 beyond the range of double
    const double held = epsilon > 0 ? -std::log10(epsilon) : static_cast<double>(scene_.run.digits);
    double error = 2 * std::sqrt(1 + static_cast<double>(engine_.counts().collisions) / active);
    const bool velocities = scene_.run.coordinates == Coordinates::absolute || scene_.law.type != LawType::inelastic ||
                            scene_.run.collapse == scene::CollapsePolicy::merge;
    if (velocities && energy > 0) error *= std::sqrt(std::max(1., to_double(energy_) / energy));
    return std::max(0., held - std::log10(error));
  }

  RunOutcome finish(Status status, const T& time) {
    const Counts& counts = engine_.counts();
    RunOutcome end;
    end.end = end_of(status, engine_.account().order_lost > 0);
    if (end.end == RunEnd::collapsed && !engine_.collapse()->settled) end.end = RunEnd::small_gap;
    end.collisions = counts.collisions;
    end.merges = counts.merges;
    end.time = to_double(time);
    end.energy = to_double(energy_now(engine_, energy_));
    end.energy_digits = energy_digits(end.energy);
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
          Attribute("ledger_error", to_double(T(energy_ - engine_.energy_lost() - engine_.kinetic_energy())))})
      end.result.attributes.push_back(attribute);
    if (account.uncertain || account.uncertain_end)
      end.result.attributes.emplace_back("uncertain_from", account.first_uncertain.value);
    put_tables(end);
    if (status == Status::collapsed) {
      const ReportedCollapse collapse = reported(*engine_.collapse());
      end.report = collapse_report(collapse, counts.collisions);
      end.collapse_time = (collapse.settled ? collapse.time : collapse.last_collision).digits;
      end.result.groups.push_back(collapse_table(collapse));
    }
    return end;
  }

  void put_tables(RunOutcome& end) {
    put_rows();
    std::vector<Group>& groups = end.result.groups;
    groups = std::move(tables_).in_order();
    // There also where there was no collision.
    if (scene_.output.events && options_.store != nullptr) append(groups, tables(events_.take(), true));
    if (scene_.output.events) {
      const Configuration<T> now = engine_.configuration_at_last_collision();
      append(groups, tables(initial_rows(*particles_, now.from, now.to), options_.store != nullptr));
    }
    if (zone_) {
      const double single = 2 * std::sqrt(scene_.law.loss.value);  // u_crit of single particles
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
  ScenarioWatch scenario_;
  EventRecorder<T> events_;
  Observer<T> observer_;
  std::uint64_t guarded_at_ =
      0;  // collisions made, at the last check of all particles, and the time of the last of them
  T collision_before_;
  RunStatus status_;      // then
  GrowingTables tables_;  // where there is no keeper
};

}  // namespace cradle::tools
