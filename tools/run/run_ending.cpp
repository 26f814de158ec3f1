#include "cradle/tools/run/run_ending.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/engines/in_precision.hpp"
#include "cradle/tools/run/report.hpp"

namespace cradle::tools {

namespace {

// About how many digits of the energy at the end are right. C collisions of N particles each round a speed by eps,
// together by eps sqrt(1 + C/N), and change the energy by twice that. If the chain holds closing speeds, the error is
// relative to the present ones; if it holds velocities, to those at the start. Where collisions make errors grow, only
// an engine that watches them knows by how much.
double energy_digits(const Scene& scene, const AnyEngine& engine, const Moment& now) {
  const double at_start = now.energy_at_start().value, at_end = now.state().energy.value;
  const auto active = static_cast<double>(std::max<ParticleIndex>(engine.collided_particles(), 1));
  const auto epsilon = in_precision<double>(scene, []<class T>(std::type_identity<T>) {
    return to_double(T(std::numeric_limits<T>::epsilon()));  // 0 beyond the range of double
  });
  const double held = epsilon > 0 ? -std::log10(epsilon) : static_cast<double>(scene.run.digits);
  double error = 2 * std::sqrt(1 + static_cast<double>(engine.counts().collisions) / active);
  const bool velocities = scene.run.coordinates == Coordinates::absolute || particles_merge(scene);
  if (velocities && at_end > 0) error *= std::sqrt(std::max(1., at_start / at_end));
  const double digits = held - std::log10(error);
  const std::optional<double> off = at_end > 0 ? now.energy_deviation(at_end) : std::nullopt;
  return std::max(0., off ? std::min(digits, -std::log10(*off)) : digits);
}

// If rounding may move a collision across the end of a run, it may be the last one, which should not have been made, or
// one that should have come at any time after it; without a last one, at any time of the run. The double is not later
// than that.
double before_last_collision(const Scene& scene, const AnyEngine& engine) {
  const Decimal& start = scene.run.start;
  const bool none = engine.counts().collisions == 0;
  if (none && !(from_text<bin_float>(start.text) < bin_float(start.value))) return start.value;
  return std::nextafter(none ? start.value : engine.last_collision_time().value,
                        -std::numeric_limits<double>::infinity());
}

}  // namespace

RunEnding::RunEnding(const Scene& scene, const AnyEngine& engine, const Moment& now, Status status) {
  const Counts& counts = engine.counts();
  ReportedAccount account = engine.account();
  const auto found = status == Status::collapsed ? std::optional(engine.collapse()) : std::nullopt;
  outcome.end = end_of(status, account.order_lost > 0);
  if (found && !found->settled) outcome.end = scene.run.stop_gap ? RunEnd::small_gap : RunEnd::unproved;
  outcome.collisions = counts.collisions;
  outcome.merges = counts.merges;
  outcome.time = now.time.meant.value;
  outcome.energy = now.state().energy.value;
  outcome.energy_digits = energy_digits(scene, engine, now);
  if (const auto particle = now.uncertain(); particle && !account.uncertain && status == Status::reached) {
    account.uncertain_end = true;
    account.first_uncertain = {now.time.meant, 0, *particle};
  }
  outcome.warning = account_warning(account, scene);
  if (status == Status::exhausted)
    outcome.warning += exhausted_warning(now.time.exact.text(), counts.collisions, scene);
  attributes = {{"simultaneous_collisions", account.simultaneous},
                {"order_lost", account.order_lost},
                {"unresolved_gaps", account.unresolved},
                {"energy_digits", outcome.energy_digits},
                {"ledger_error", now.ledger_error()}};
  if (account.uncertain || account.uncertain_end)
    attributes.emplace_back("uncertain_from", account.uncertain_end ? before_last_collision(scene, engine)
                                                                    : account.first_uncertain.time.value);
  if (!found) return;
  const std::string floor = collapsing_floor(scene);
  const bool on_floor =
      floor == "walls.left" ? found->particle < 0 : floor == "walls.right" && found->particle + 1 == engine.particles();
  outcome.report = collapse_report(*found, outcome.end, outcome.collisions, on_floor ? floor : "");
  outcome.collapse_time = (found->settled ? found->time : found->last_collision).text();
  collapse = collapse_table(*found);
}

}  // namespace cradle::tools
