// A run with everything fixed that the hot loop is a template of: scalar, law, chain. Compiled once per scalar type
// (see tools/CMakeLists.txt); run.cpp chooses.
#pragma once

#include <fmt/format.h>

#include <csignal>
#include <functional>

#include "cradle/core/cluster_chain.hpp"
#include "cradle/core/gap_chain.hpp"
#include "cradle/core/observe/trace.hpp"
#include "cradle/core/position_chain.hpp"
#include "cradle/core/sticky_gas.hpp"
#include "cradle/core/theory/wet_zone.hpp"
#include "cradle/tools/run/recorder.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/run/schedule.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

inline std::string place(BodyIndex left) { return fmt::format("between bodies {} and {}", left, left + 1); }

// Seven digits of a number that may be far below the range of double.
template <Real T> std::string brief(const T& x) {
  const double rounded = to_double(x);
  if (rounded != 0 || x == T(0)) return fmt::format("{:.6e}", rounded);
  const std::string text = to_text(x);
  const auto exponent = text.find_first_of("eE");
  return text.substr(0, std::min<std::size_t>(exponent, 8)) + text.substr(exponent);
}

// The collapse report: times with all digits of the type.
template <Real T> std::string collapse_report(const CollapseReport<T>& r, const Counts& counts) {
  const std::string t_c = to_text(r.time.value());
  std::string text = r.extrapolated ? fmt::format("inelastic collapse at t_c = {} +- {}\n", t_c, brief(r.uncertainty))
                                    : std::string("inelastic collapse: a gap fell below the smallest that is followed; "
                                                  "no collapse time could be extrapolated\n");
  text +=
      fmt::format("  last contact   t = {}, number {}, {}\n", to_text(r.last_contact), counts.contacts, place(r.body));
  text += fmt::format("  smallest gap   {} beside it\n", brief(r.gap));
  if (r.extrapolated)
    text += fmt::format("  intervals      {}, shrinking by {:.12g} from one contact there to the next\n",
                        brief(r.interval), to_double(r.ratio));
  text += "  to go on       give law.cutoff a speed, or run.stop_gap a smaller gap to follow the collapse further\n";
  return text;
}

template <Real T> std::string account_warning(const Account<T>& account, Coordinates coordinates) {
  std::string text;
  if (account.order_lost > 0)
    text +=
        fmt::format("order of contacts lost ({} times, first at t = {} {}, gap {:.3e}): use more digits (run.precision)"
                    "{}\n",
                    account.order_lost, to_text(account.first_order_lost.time), place(account.first_order_lost.body),
                    to_double(account.first_order_lost.gap),
                    coordinates == Coordinates::absolute ? " or run.coordinates = \"gaps\"" : "");
  if (account.unresolved > 0)
    text += fmt::format(
        "gaps below 1e6 units in the last place of x ({} contacts, first at t = {} {}, gap {:.3e}): results that "
        "depend on such gaps cannot be trusted; use run.coordinates = \"gaps\" or more digits\n",
        account.unresolved, to_text(account.first_unresolved.time), place(account.first_unresolved.body),
        to_double(account.first_unresolved.gap));
  if (account.simultaneous > 0)
    text += fmt::format("three bodies met within rounding ({} contacts): the tie rule decided their order; perturb the "
                        "initial state where that matters\n",
                        account.simultaneous);
  return text;
}

inline ZoneAverage zone_average(const Scene& scene) {
  const Zone& zone = scene.output.zone;
  double reach = 0;
  if (zone.reach)
    reach = zone.reach->value;
  else
    try {
      const theory::WetShock<double> shock{
          .loss = scene.law.loss.value, .speed = scene.initial.speed.value, .spacing = scene.initial.spacing.value};
      reach = 3 * theory::WetZone<double>(shock).half_width();
    } catch (const std::domain_error& error) {
      throw Error({scene.name, 0, "output.zone.reach"}, "not given, and (13) has no answer", error.what(), "give it");
    }
  return {reach, zone.bins, zone.samples, 1.0};
}

template <Real T, class Simulation> class SceneRun {
 public:
  SceneRun(const Scene& scene, std::shared_ptr<const cradle::Bodies<T>> bodies, Simulation simulation,
           const RunOptions& options, Progress& progress)
      : scene_(scene), options_(options), bodies_(std::move(bodies)), energy_(bodies_->kinetic_energy()),
        simulation_(std::move(simulation)), progress_(progress), plan_(schedule<T>(scene)) {
    if (scene.output.zone.from) zone_.emplace(zone_average(scene));
  }

  RunOutcome operator()() {
    if (scene_.output.events) observer_ = [this](const Contact<T>& c) { events_(c); };
    if (scene_.output.scenario)
      observer_ = [this, record = std::move(observer_)](const Contact<T>& c) {
        if (record) record(c);
        scenario_.contact(c.left, c.right, to_double(T(c.time.value())), simulation_.counts().merges);
      };
    if (options_.trace) observer_ = [this](const Contact<T>& c) { trace_.contact(c.left, c.right); };
    Status status = Status::reached;
    for (const T& stop : plan_.stops) {
      status = advance(stop);
      if (status != Status::reached) break;
      look(stop);
      progress_.tell(to_double(stop), simulation_.counts().contacts);
    }
    if (status != Status::reached) record_end(simulation_.last_contact_time());
    return finish(status);
  }

 private:
  // Others go from time to time without any.
  static constexpr bool makes_contacts = requires(const Simulation& run) { run.chain(); };

  static bool take(const std::vector<T>& times, std::size_t& next, const T& time) {
    if (next >= times.size() || times[next] != time) return false;
    ++next;
    return true;
  }

  Status advance(const T& until) {
    if constexpr (makes_contacts) return observer_ ? simulation_.advance(until, observer_) : simulation_.advance(until);
    const Status status = simulation_.advance(until);
    return noted_signal() == 0 ? status : Status::interrupted;
  }

  void look(const T& time) {
    if (take(plan_.series, next_series_, time)) record_sample(time);
    const bool snapshot = take(plan_.snapshots, next_snapshot_, time),
               profiled = take(plan_.profiles, next_profile_, time), masses = take(plan_.masses, next_masses_, time),
               zone = take(plan_.zone, next_zone_, time);
    if (!snapshot && !profiled && !masses && !zone) return;
    const Configuration<T> now = simulation_.configuration(time);
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
    else if (simulation_.collided_bodies() > 0 && !simulation_.on_ring())
      range = {to_double(simulation_.front_left(time)), to_double(simulation_.front_right(time))};
    if (!(range.from < range.to)) range.to = range.from + 1;  // all in one place: one length around it
    profiles_.push_back(
        profile_table(profile(now, *bodies_, elapsed, range, wanted.bins), numbered("profiles", profiles_.size())));
  }

  void record_sample(const T& time) {
    const Sample<T> now = sample(simulation_, energy_, time);
    series_.add(now);
    if (cloudy()) {
      const Cloud<T> seen = cloud(simulation_.configuration(time));
      cloud_.add(seen);
      if (scene_.output.scenario)
        scenario_.look(seen, to_double(T(time - number<T>(scene_.run.start))), simulation_.counts().merges);
    }
    if (options_.trace)
      trace_samples_.push_back({to_double(time), trace_.digest(), now.counts.contacts, now.counts.merges,
                                to_text(now.energy), now.front_right ? to_text(*now.front_right) : std::string()});
  }

  // A run that ends early leaves its last state.
  void record_end(const T& time) {
    record_sample(time);
    snapshots_.push_back(snapshot_table(simulation_.configuration(time), numbered("snapshots", snapshots_.size())));
  }

  // Bodies that merge on a line make two heavy clusters; on a ring none are like them.
  bool cloudy() const { return scene_.law.type != LawType::inelastic && scene_.initial.type != InitialType::ring; }

  static std::string numbered(const char* folder, std::size_t number) {
    return fmt::format("{}/{:04}", folder, number);
  }

  RunOutcome finish(Status status) {
    const auto& account = simulation_.account();
    const Counts& counts = simulation_.counts();
    RunOutcome end;
    end.contacts = counts.contacts;
    end.merges = counts.merges;
    end.energy = to_double(T(energy_ - simulation_.energy_lost()));
    std::string outcome = "reached the end";
    end.warning = account_warning(account, scene_.run.coordinates);
    switch (status) {
    case Status::reached:
      if (account.order_lost > 0) outcome = "order of contacts lost", end.status = Exit::lost;
      break;
    case Status::collapsed:
      outcome = "inelastic collapse", end.status = Exit::collapse;
      if constexpr (makes_contacts) end.report = collapse_report(simulation_.collapse(), counts);
      break;
    case Status::exhausted:
      outcome = "resolution exhausted", end.status = Exit::lost;
      end.warning += fmt::format("resolution exhausted (t = {}, {} contacts): time or a gap can get no smaller in {}; "
                                 "use {}a law.cutoff, or collapse = \"stop\"\n",
                                 to_text(simulation_.last_contact_time()), counts.contacts, precision_name(scene_.run),
                                 scene_.run.coordinates == Coordinates::absolute ? "run.coordinates = \"gaps\", " : "");
      break;
    case Status::interrupted:
      outcome = "interrupted";
      end.status = noted_signal() == SIGINT ? Exit::interrupted : Exit::terminated;
      break;
    }
    end.result.attributes = {{"format_version", std::uint64_t{1}},
                             {"cradle_version", std::string(version)},
                             {"scene", effective_toml(scene_)},
                             {"name", scene_.name},
                             {"precision", precision_name(scene_.run)},
                             {"outcome", outcome},
                             {"simultaneous_contacts", account.simultaneous},
                             {"order_lost", account.order_lost},
                             {"unresolved_gaps", account.unresolved},
                             {"close_calls", counts.close_calls}};
    end.result.groups.push_back(std::move(series_).table());
    if (cloudy()) end.result.groups.push_back(std::move(cloud_).table(end.result.groups.back()));
    for (auto* groups : {&snapshots_, &profiles_, &masses_})
      for (auto& group : *groups) end.result.groups.push_back(std::move(group));
    if (zone_) {
      const double speed = scene_.initial.speed.value;
      const ZoneWidth width = zone_->width(speed, 2 * std::sqrt(scene_.law.loss.value));  // u_crit of single bodies
      end.result.groups.push_back(
          zone_table(*zone_, width, scene_.output.zone.bins, scene_.output.zone.from->value, scene_.run.until.value));
      end.summary.emplace_back("zone_width", width.width);
    }
    if (scene_.output.scenario) {
      const auto numbers = scenario_numbers(scenario_.result(counts.merges));
      end.result.groups.push_back({"scenario", {numbers.begin(), numbers.end()}, {}});
      end.summary.insert(end.summary.end(), numbers.begin(), numbers.end());
    }
    if (scene_.output.events) end.result.groups.push_back(std::move(events_).table());
    if constexpr (makes_contacts)
      if (status == Status::collapsed) {
        end.result.groups.push_back(collapse_table());
        end.collapse_time = to_text(T(simulation_.collapse().time.value()));
      }
    end.trace = std::move(trace_samples_);
    return end;
  }

  Group collapse_table() const {
    const auto& r = simulation_.collapse();
    return {"collapse",
            {{"time", to_double(T(r.time.value()))},
             {"uncertainty", to_double(r.uncertainty)},
             {"last_contact", to_double(r.last_contact)},
             {"interval", to_double(r.interval)},
             {"ratio", to_double(r.ratio)},
             {"gap", to_double(r.gap)},
             {"body", static_cast<std::uint64_t>(r.body)}},
            {}};
  }

  const Scene& scene_;
  const RunOptions& options_;
  std::shared_ptr<const cradle::Bodies<T>> bodies_;
  T energy_;
  Simulation simulation_;
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
  std::function<void(const Contact<T>&)> observer_;
  std::vector<Group> snapshots_, profiles_, masses_;
};

// ---- from names to types

template <Real T, class Law, class Chain>
RunOutcome run_on(const Scene& scene, std::shared_ptr<const cradle::Bodies<T>> bodies, Law law, Chain chain,
                  const RunOptions& options, Progress& progress) {
  Policy<T> policy;
  // Elastic bodies do not collapse, those that stick cannot.
  if (scene.run.collapse == CollapsePolicy::stop && scene.law.type == LawType::inelastic &&
      scene.law.restitution < Decimal("1"))
    policy.collapse = cradle::CollapsePolicy::stop;
  if (scene.run.stop_gap) policy.stop_gap = number<T>(*scene.run.stop_gap);
  policy.interrupt = [] { return noted_signal() != 0; };
  policy.progress = [&progress](const T& time, const Counts& counts) {
    progress.tell(to_double(time), counts.contacts);
  };
  using Engine = Simulation<T, Law, Chain>;
  Engine engine(std::move(law), std::move(chain), policy);
  return SceneRun<T, Engine>(scene, std::move(bodies), std::move(engine), options, progress)();
}

template <class T> RunOutcome run_in(const Scene& scene, const RunOptions& options) {
  const auto bodies = initial_bodies<T>(scene);
  const T start = number<T>(scene.run.start);
  Progress progress(options.progress, scene.run.start.value, scene.run.until.value);
  if (scene.law.type == LawType::wet)
    return run_on<T>(scene, bodies, Wet<T>(number<T>(scene.law.loss)), ClusterChain<T>(bodies, start), options,
                     progress);
  if (scene.law.type == LawType::sticky && !scene.output.events && !options.trace) {
    using Gas = StickyGas<T>;  // where nobody asks for contacts none need be made
    return SceneRun<T, Gas>(scene, bodies, Gas(bodies, start), options, progress)();
  }
  if (scene.law.type == LawType::sticky || scene.run.collapse == CollapsePolicy::merge) {
    const bool sticky = scene.law.type == LawType::sticky;
    const InelasticMerging<T> law(Inelastic<T>(sticky ? T(0) : number<T>(scene.law.restitution)),
                                  sticky ? std::numeric_limits<T>::max() : number<T>(scene.run.merge_speed));
    return run_on<T>(scene, bodies, law, ClusterChain<T>(bodies, start), options, progress);
  }
  const auto bouncing = [&](auto law) {
    if (scene.run.coordinates == Coordinates::absolute)
      return run_on<T>(scene, bodies, law, PositionChain<T>(bodies, start), options, progress);
    if (bodies->identical_masses()) return run_on<T>(scene, bodies, law, GapChain<T>(bodies, start), options, progress);
    return run_on<T>(scene, bodies, law, GapChain<T, IndividualMasses<T>>(bodies, start), options, progress);
  };
  const Inelastic<T> law(number<T>(scene.law.restitution), number<T>(scene.law.cutoff));
  if (scene.run.collapse == CollapsePolicy::contact_time)
    return bouncing(ContactTime<T>(law, number<T>(scene.run.contact_time)));
  return bouncing(law);
}

}  // namespace cradle::tools
