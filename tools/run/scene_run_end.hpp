#pragma once
// The end of a run: its outcome, with the warnings that the account gives rise to, and the tables of all that the run
// has recorded.

#include "cradle/tools/run/scene_run_in.hpp"

namespace cradle::tools {

template <Real T> inline void SceneRunIn<T>::end_with(Status status) {
  const bool reached = status == Status::reached, interrupted = status == Status::interrupted;
  const T end = reached ? plan_.stops.back() : engine_->last_collision_time();
  if (reached || interrupted) keep(end, reached ? RunIs::over : RunIs::interrupted);
  if (!reached && !(interrupted && sink_.for_file())) record_end(end);
  std::vector<Attribute> attributes;
  RunOutcome how = outcome(status, end, attributes);
  how.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  sink_.end(std::move(attributes), how.end);
  over_ = std::move(how);
}

// Records the last state of a run that ends early.
template <Real T> inline void SceneRunIn<T>::record_end(const T& time) {
  guards_.require_between_walls(time);
  if (options_.observer != nullptr) notify_observer(time, true);
  const Given<T> at(time);
  record_sample(at);
  put(snapshot_rows(engine_->configuration_at_last_collision(), at, numbered("snapshots", snapshots_)));
}

template <Real T>
inline RunOutcome SceneRunIn<T>::outcome(Status status, const T& time, std::vector<Attribute>& attributes) {
  const Counts& counts = engine_->counts();
  RunOutcome end;
  end.end = end_of(status, engine_->account().order_lost > 0);
  if (end.end == RunEnd::collapsed && !engine_->collapse()->settled)
    end.end = scene_.run.stop_gap ? RunEnd::small_gap : RunEnd::unproved;
  end.collisions = counts.collisions;
  end.merges = counts.merges;
  const Given<T> at = status == Status::reached ? plan_.meant(time) : Given<T>(time);
  end.time = at.rounded;
  end.energy = to_double(energy_now(*engine_, energy_, time));
  end.energy_digits = energy_digits(*engine_, scene_, to_double(energy_), end.energy);
  ReportedAccount account = reported(engine_->account());
  if (const auto particle = engine_->uncertain_at(time); particle && !account.uncertain && status == Status::reached) {
    account.uncertain_end = true;
    account.first_uncertain = {at.text, at.rounded, 0, *particle};
  }
  end.warning = account_warning(account, scene_);
  if (status == Status::exhausted) end.warning += exhausted_warning(to_text(time), counts.collisions, scene_);
  attributes = provenance(scene_, precision_name(scene_.run), end_row(end.end).text);
  for (const Attribute& attribute :
       {Attribute("simultaneous_collisions", account.simultaneous), Attribute("order_lost", account.order_lost),
        Attribute("unresolved_gaps", account.unresolved), Attribute("energy_digits", end.energy_digits),
        Attribute("ledger_error", to_double(ledger_error(time)))})
    attributes.push_back(attribute);
  if (account.uncertain || account.uncertain_end)
    attributes.emplace_back("uncertain_from", account.first_uncertain.value);
  put_tables(end, time);
  if (status == Status::collapsed) {
    const ReportedCollapse collapse = reported(*engine_->collapse());
    const std::string floor = collapsing_floor(scene_);
    const bool on_floor = floor == "walls.left"
                              ? collapse.particle < 0
                              : floor == "walls.right" && collapse.particle + 1 == particles_->count();
    end.report = collapse_report(collapse, end.end, counts.collisions, on_floor ? floor : "");
    end.collapse_time = (collapse.settled ? collapse.time : collapse.last_collision).digits;
    sink_.add(collapse_table(collapse));
  }
  return end;
}

// What the ledger leaves of the energy minus the sums over particles.
template <Real T> inline T SceneRunIn<T>::ledger_error(const T& time) const {
  T error = energy_ - engine_->energy_lost(time) - engine_->kinetic_energy(time);
  if (particles_->fall())
    error += particles_->potential_energy() -
             cradle::potential_energy(engine_->configuration(time), *particles_, T(time - number<T>(scene_.run.start)));
  return error;
}

template <Real T> inline void SceneRunIn<T>::put_tables(RunOutcome& end, const T& time) {
  put_rows();
  if (scene_.output.events) {
    for (Group& none : tables(events_.take(), sink_.for_file()))
      sink_.add(std::move(none));  // even without a collision
    const Configuration<T> now = engine_->configuration_at_last_collision();
    put(initial_rows(*particles_, now.from, now.to));
  }
  if (word_) sink_.add(word_->table());
  if (zone_) {
    const double single = 2 * std::sqrt(scene_.law.loss.value);  // u_crit of single particles
    const ZoneWidth width = zone_->width(scene_.initial.speed.value, single);
    sink_.add(zone_result(*zone_, width, scene_));
    end.summary.emplace_back("zone_width", width.width);
  }
  const auto add = [this](std::vector<Group>&& groups) {
    for (Group& table : groups) sink_.add(std::move(table));
  };
  // Statistics are of what covers the whole time only.
  const bool partial = sink_.for_file();
  if (averages_ && averages_->samples() > 0 && (partial || averages_->complete()))
    sink_.add(averages_result(*averages_, scene_));
  if (histograms_ && (partial || !(time < number<T>(scene_.output.counting.until)))) add(histograms_->tables());
  if (correlations_) add(correlations_->tables(partial));
  if (scene_.output.scenario) {
    const auto numbers = scenario_numbers(scenario_.result(engine_->counts().merges));
    sink_.add({"scenario", {numbers.begin(), numbers.end()}, {}});
    end.summary.insert(end.summary.end(), numbers.begin(), numbers.end());
  }
}

}  // namespace cradle::tools
