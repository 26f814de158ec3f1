// How a run ends: its outcome, with the warnings that its account gives rise
// to, and the attributes of its result.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cradle/tools/engines/precision.hpp"
#include "cradle/tools/record/moment.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

template <Real T> struct RunEnding {
  RunOutcome outcome;
  std::vector<Attribute> attributes;
  std::optional<Group> collapse;

  RunEnding(const Scene& scene, const MomentIn<T>& now, Status status) {
    const Engine<T>& engine = now.engine();
    const T& time = now.time.value;
    const Counts& counts = engine.counts();
    const T at_start = now.particles().kinetic_energy();
    outcome.end = end_of(status, engine.account().order_lost > 0);
    if (outcome.end == RunEnd::collapsed && !engine.collapse()->settled)
      outcome.end = scene.run.stop_gap ? RunEnd::small_gap : RunEnd::unproved;
    outcome.collisions = counts.collisions;
    outcome.merges = counts.merges;
    outcome.time = now.time.rounded;
    outcome.energy = to_double(energy_now(engine, at_start, time));
    outcome.energy_digits = energy_digits(engine, scene, to_double(at_start), outcome.energy, time);
    ReportedAccount account = reported(engine.account());
    if (const auto particle = engine.uncertain_at(time); particle && !account.uncertain && status == Status::reached) {
      account.uncertain_end = true;
      account.first_uncertain = {now.time.number(), 0, *particle};
    }
    outcome.warning = account_warning(account, scene);
    if (status == Status::exhausted) outcome.warning += exhausted_warning(to_text(time), counts.collisions, scene);
    attributes = provenance(scene, precision_name(scene.run), end_row(outcome.end).text);
    for (const Attribute& attribute :
         {Attribute("simultaneous_collisions", account.simultaneous), Attribute("order_lost", account.order_lost),
          Attribute("unresolved_gaps", account.unresolved), Attribute("energy_digits", outcome.energy_digits),
          Attribute("ledger_error", to_double(ledger_error(scene, now)))})
      attributes.push_back(attribute);
    if (account.uncertain || account.uncertain_end)
      attributes.emplace_back("uncertain_from", account.first_uncertain.time.value);
    if (status == Status::collapsed) add_collapse(scene, now);
  }

 private:
  void add_collapse(const Scene& scene, const MomentIn<T>& now) {
    const ReportedCollapse found = reported(*now.engine().collapse());
    const std::string floor = collapsing_floor(scene);
    const bool on_floor = floor == "walls.left"
                              ? found.particle < 0
                              : floor == "walls.right" && found.particle + 1 == now.particles().count();
    outcome.report = collapse_report(found, outcome.end, outcome.collisions, on_floor ? floor : "");
    outcome.collapse_time = (found.settled ? found.time : found.last_collision).text;
    collapse = collapse_table(found);
  }
  // What the ledger leaves of the energy minus the sums over particles.
  static T ledger_error(const Scene& scene, const MomentIn<T>& now) {
    const Engine<T>& engine = now.engine();
    const cradle::Particles<T>& particles = now.particles();
    const T& time = now.time.value;
    T error = particles.kinetic_energy() - engine.energy_lost(time) - engine.kinetic_energy(time);
    if (particles.fall())
      error += particles.potential_energy() -
               cradle::potential_energy(engine.configuration(time), particles, T(time - number<T>(scene.run.start)));
    return error;
  }
};

}  // namespace cradle::tools
