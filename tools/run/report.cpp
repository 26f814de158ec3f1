#include "cradle/tools/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cradle/precision/bin_float.hpp"
#include "cradle/tools/record/rows.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

namespace {

std::string place(ParticleIndex left) {
  if (left < 0) return "between the left wall and particle 0";
  return fmt::format("between particles {} and {}", left, left + 1);
}

// The decimal exponent of a number's first digit; none for 0.
std::optional<std::int64_t> first_digit(const std::string& text) {
  const auto decimal = canonical_decimal(text);
  const DecimalParts parts = decimal ? parts_of(*decimal) : DecimalParts();
  return parts.digits.empty() ? std::nullopt : std::optional(parts.exponent() - 1);
}

// A double may be 0 where the number is not.
bool is_zero(const Number& x) { return x.value == 0 && !first_digit(x.text()); }

// Seven digits of a number that may be far below the range of double.
std::string brief(const Number& x) {
  if (x.value != 0 || is_zero(x)) return fmt::format("{:.6e}", x.value);
  const std::string text = x.text();
  const auto exponent = text.find_first_of("eE");
  return text.substr(0, std::min<std::size_t>(exponent, 8)) + text.substr(exponent);
}

// Two digits, rounded up, plus 20 % for the digits that are cut off from the number beside it.
std::string error_text(const Number& error) {
  const double more = error.value * 1.2;
  return more > 0 ? fmt::format("{:.1e}", more) : brief(error);
}

// "1.71428571428571428 +- 3.8e-15": the number down to a tenth of the error's first digit, if it has so many digits.
std::string within(const Number& x, const Number& error) {
  const std::string text = x.text();
  const auto of_number = first_digit(text), of_error = first_digit(error.text());
  if (!of_number || !of_error) return text;
  const auto exponent = text.find_first_of("eE");
  std::string mantissa = text.substr(0, exponent);
  const auto first = mantissa.find_first_of("123456789");
  auto wanted = std::max<std::int64_t>(*of_number - *of_error + 2, 1);
  std::size_t end = first;
  for (; end < mantissa.size() && wanted > 0; ++end) wanted -= mantissa[end] != '.';
  if (const auto point = mantissa.find('.'); point != std::string::npos) end = std::max(end, point);
  mantissa.resize(std::min(end, mantissa.size()));
  // The cut-off part is less than a tenth of the error; error_text adds more than that.
  return mantissa + (exponent == std::string::npos ? "" : text.substr(exponent)) + " +- " + error_text(error);
}

// The text for standard output; times have all digits that are known.
std::string collapse_report(const ReportedCollapse& r, RunEnd end, std::uint64_t collisions) {
  std::string text =
      r.settled ? fmt::format("inelastic collapse at t_c = {}\n", within(r.time, r.uncertainty))
      : end == RunEnd::small_gap
          ? std::string("a gap fell below run.stop_gap: the run stops there as requested; that this is an inelastic "
                        "collapse is not proved, and no time of it is known\n")
          : std::string(
                "many particles collapse: a gap fell below 2^-100 of what the gap beside it was at the start. A "
                "run of more than 16 particles without run.stop_gap ends there; that this is an inelastic "
                "collapse is not proved, and no time of it is known\n");
  text +=
      fmt::format("  last collision t = {}, number {}, {}\n", r.last_collision.text(), collisions, place(r.particle));
  text += fmt::format("  smallest gap   {} beside it\n", brief(r.gap));
  if (!is_zero(r.interval))
    text += fmt::format("  interval       {} since the collision there before\n", brief(r.interval));
  if (r.settled)
    text += fmt::format("  ratio          {} of successive intervals there\n", within(r.ratio, r.ratio_uncertainty));
  return text;
}

// With their decimals below /exact if the run's type is wider than double.
std::vector<Group> collapse_tables(const ReportedCollapse& r) {
  const auto if_known = [&](const Number& x) { return r.settled ? x : Number{none(), nullptr}; };
  const std::pair<const char*, Number> numbers[] = {{"time", r.settled ? r.time : r.last_collision},
                                                    {"uncertainty", if_known(r.uncertainty)},
                                                    {"last_collision", r.last_collision},
                                                    {"interval", r.interval},
                                                    {"ratio", if_known(r.ratio)},
                                                    {"ratio_uncertainty", if_known(r.ratio_uncertainty)},
                                                    {"gap", r.gap}};
  Group table{"collapse", {}, {}}, exact{std::string(exact_folder) + table.name, {}, {}};
  for (const auto& [name, x] : numbers) {
    table.attributes.emplace_back(name, x.value);
    exact.attributes.emplace_back(name, x.text());
  }
  table.attributes.emplace_back("particle", static_cast<std::uint64_t>(r.particle));
  return r.gap.exact ? std::vector{std::move(exact), std::move(table)} : std::vector{std::move(table)};
}

// Whether the scene asks for averages over many collisions, to which the order of single ones does not matter.
bool measures_averages(const Scene& scene) {
  return std::ranges::any_of(measurement_rows(), [&](const MeasurementRow* row) {
    return row->of_many_collisions && !row->tables_at_end(scene).empty();
  });
}

// What keeps three particles from meeting at one time.
std::string apart(const Scene& scene) {
  if (scene.law.type == LawType::inelastic && scene.law.restitution == Decimal("0"))
    return "with law.restitution = 0 particles stay together; give a small one to part them";
  return scene.initial.type == InitialType::list
             ? "where that matters, give other initial.x or initial.v"
             : "where that matters, give unequal distances, by initial.perturbation or initial.positions = \"poisson\"";
}

// The text for standard error; empty if everything was resolved.
std::string account_warning(const Account<Number>& account, bool uncertain_end, const Scene& scene) {
  const Run& run = scene.run;
  std::string text;
  if (account.order_lost > 0)
    text += fmt::format(
        "order of collisions lost ({} times, first at t = {} {}, gap {:.3e}): use more digits (run.precision){}\n",
        account.order_lost, account.first_order_lost.time.text(), place(account.first_order_lost.particle),
        account.first_order_lost.gap.value,
        run.coordinates == Coordinates::absolute ? " or run.coordinates = \"gaps\"" : "");
  if (account.unresolved > 0)
    text += fmt::format(
        "gaps below 1e6 units in the last place of x ({} collisions, first at t = {} {}, gap {:.3e}): results that "
        "depend on such gaps cannot be trusted; use run.coordinates = \"gaps\" or more digits\n",
        account.unresolved, account.first_unresolved.time.text(), place(account.first_unresolved.particle),
        account.first_unresolved.gap.value);
  if (account.simultaneous > 0)
    text += fmt::format(
        "{} times three particles met at one time, within rounding: then the numbers do not say which pair collides "
        "first, and the left one is taken; {} (particles that rest on one another always meet so)\n",
        account.simultaneous, apart(scene));
  if (const double grown = account.first_uncertain.gap.value; account.uncertain > 0)
    text += fmt::format(
        "collisions are certain up to t = {} only: there rounding, which has grown to {} {}, may have decided "
        "which one was next ({:.0f} digits of a length of 1 are left in {}); the collisions after it are those of a "
        "system that starts a rounding away. {} more digits (run.precision), and `cradle trust` to see how many\n",
        account.first_uncertain.time.text(), grown > 0 ? fmt::format("{:.1e}", grown) : "less than 1e-308",
        place(account.first_uncertain.particle), std::max(0., -std::log10(std::max(grown, 1e-308))),
        precision_name(run),
        measures_averages(scene) ? "Averages over many collisions are as good from it; to follow one motion use"
                                 : "Use");
  const auto& [time, particle, error] = account.first_uncertain;
  if (uncertain_end)
    text += fmt::format("rounding may decide which collisions come before the end (t = {}, {}): use more digits "
                        "(run.precision), or another run.until\n",
                        time.text(), particles_merge(scene) ? fmt::format("particle {}", particle) : place(particle));
  return text;
}

// The warning when time or a gap cannot get smaller; `rests`: of one particle, on a floor.
std::string exhausted_warning(const Number& time, std::uint64_t collisions, const Scene& scene, bool rests) {
  const Run& run = scene.run;
  const bool stops = run.collapse == scene::CollapsePolicy::stop, cut_off = scene.law.cutoff > Decimal("0");
  const std::string floor = collapsing_floor(scene);
  std::string remedies = run.coordinates == Coordinates::absolute ? "run.coordinates = \"gaps\", " : "";
  if (!floor.empty())
    remedies += fmt::format("{}.rest_speed, a speed below which particles stay on this wall, ", floor);
  remedies += cut_off ? "a higher law.cutoff, or none, with which a run ends at a collapse" : "a law.cutoff";
  if (!cut_off && !run.stop_gap)
    remedies += stops ? ", or run.stop_gap to end there" : ", or run.collapse = \"stop\" to end there";
  if (floor.empty())  // on a floor no number of digits is enough
    remedies += run.precision == Precision::mpfr
                    ? ", or more digits (run.digits)"
                    : ", or more digits (run.precision; long double reaches gaps of 1e-4932, mpfr any)";
  if (rests)
    return fmt::format("the particle has come to rest on the {} wall at about t = {:.6g} ({} collisions): for the "
                       "run to continue, use {}\n",
                       floor.substr(floor.find('.') + 1), time.value, collisions, remedies);
  return fmt::format("resolution exhausted (t = {}, {} collisions): time or a gap can get no smaller in {}{}; use {}\n",
                     time.text(), collisions, precision_name(run),
                     stops ? ", and that this is an inelastic collapse is not proved" : "", remedies);
}

// About how many digits of the energy at the end are right. C collisions of N particles each round a speed by eps,
// together by eps sqrt(1 + C/N), and change the energy by twice that. If the chain holds closing speeds, the error is
// relative to the present ones; if it holds velocities, to those at the start. Where collisions make errors grow, or a
// threshold decides what happens, only an engine that watches them knows by how much: `grown` says that none has. After
// an uncertain collision no digit is right, unless nothing is changed.
double energy_digits(const Scene& scene, const AnyEngine& engine, const RunState& now, bool uncertain, bool& grown) {
  const double at_start = now.energy_at_start().value, at_end = now.state().energy.value;
  const std::optional<double> off = at_end > 0 ? now.energy_deviation(at_end) : 0;
  const bool heated = scene.walls.left.temperature || scene.walls.right.temperature;
  grown = !off && (particles_merge(scene) || heated || scene.walls.shaken() || scene.gravity.acts() ||
                   unequal_masses(scene) || scene.run.coordinates == Coordinates::absolute);
  if (uncertain && (at_start != at_end || engine.counts().collisions == 0)) return 0;
  const auto active = static_cast<double>(std::max<ParticleIndex>(engine.collided_particles(), 1));
  double error = 2 * std::sqrt(1 + static_cast<double>(engine.counts().collisions) / active);
  const bool velocities = scene.run.coordinates == Coordinates::absolute || particles_merge(scene);
  if (velocities && at_end > 0) error *= std::sqrt(std::max(1., at_start / at_end));
  const double digits = static_cast<double>(-std::log10(engine.epsilon())) - std::log10(error);
  return std::max(0., std::min(digits, -std::log10(off.value_or(0))));
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

struct GuardRow {
  Guard type;
  const char* broken;
};
constexpr GuardRow guard_rows[] = {
    {Guard::order, "order: two particles have changed places, the gap is less than rounding can make it"},
    {Guard::wall, "wall: a particle is beyond it"},
    {Guard::past, "past: the last collision is not between the one before and the time of the check"},
    {Guard::energy, "energy: the sum over all particles is not what the ledger of losses leaves"},
    {Guard::momentum, "momentum: not what it was at the start"},
    {Guard::closure, "closure: gaps or closing speeds do not add up to what the ends of the line give"},
};
static_assert(rows_in_order(guard_rows));

}  // namespace

std::string guard_message(const ReportedGuard& g, const Account<Number>& account, const Run& run) {
  const std::string broken =
      fmt::format("stopped by the guard of {} (found {:.6g}, bound {:.6g}, at t = {}{}): ",
                  guard_rows[static_cast<std::size_t>(g.guard)].broken, g.found, g.bound, g.time.text(),
                  g.guard == Guard::wall ? fmt::format(", particle {}", g.particle)
                  : g.particle < 0       ? ""
                                         : ", " + place(g.particle));
  // A gap to a wall that has just closed is not in the account.
  if (run.coordinates == Coordinates::absolute &&
      (account.order_lost + account.unresolved > 0 || g.guard == Guard::wall))
    return broken + "positions do not resolve what decides the next collisions. Use run.coordinates = \"gaps\", or "
                    "more digits (run.precision)";
  return broken + "the machine or the program is at fault. `cradle resume` continues from the last checkpoint, made "
                  "before; if it stops here again, please report the scene";
}

RunOutcome outcome_of(const Scene& scene, const AnyEngine& engine, const RunState& now, Status status) {
  RunOutcome outcome;
  if (status == Status::collapsed) {
    const ReportedCollapse found = engine.collapse();
    outcome.end = found.settled ? RunEnd::collapsed : scene.run.stop_gap ? RunEnd::small_gap : RunEnd::unproved;
    outcome.collapsed_at = found.settled ? found.time.value : found.last_collision.value;
  } else {
    outcome.end = status == Status::exhausted       ? RunEnd::exhausted
                  : status == Status::interrupted   ? RunEnd::interrupted
                  : engine.account().order_lost > 0 ? RunEnd::order_lost
                                                    : RunEnd::reached;
  }
  outcome.collisions = engine.counts().collisions, outcome.merges = engine.counts().merges;
  outcome.time = now.time.meant.value;
  outcome.energy = now.state().energy.value;
  return outcome;
}

RunEnding::RunEnding(const Scene& scene, const AnyEngine& engine, const RunState& now, Status status)
    : outcome(outcome_of(scene, engine, now, status)) {
  Account<Number> account = engine.account();
  const auto found = status == Status::collapsed ? std::optional(engine.collapse()) : std::nullopt;
  const auto particle = now.uncertain();
  const bool uncertain_end = particle && account.uncertain == 0 && status == Status::reached;
  outcome.energy_digits =
      energy_digits(scene, engine, now, account.uncertain > 0 || uncertain_end, outcome.may_have_grown);
  if (uncertain_end) account.first_uncertain = {now.time.meant, *particle};
  const bool rests = status == Status::exhausted && engine.particles() == 1 && !collapsing_floor(scene).empty() &&
                     scene.run.coordinates == Coordinates::gaps;
  if (rests) account.uncertain = 0;  // no digits decide which collision is next
  outcome.warning = account_warning(account, uncertain_end, scene);
  if (status == Status::exhausted)
    outcome.warning += exhausted_warning(now.time.exact, outcome.collisions, scene, rests);
  attributes = {{"simultaneous_collisions", account.simultaneous},
                {"order_lost", account.order_lost},
                {"unresolved_gaps", account.unresolved},
                {"energy_digits", outcome.energy_digits},
                {"ledger_error", now.ledger_error()}};
  if (account.uncertain > 0 || uncertain_end)
    attributes.emplace_back("uncertain_from",
                            uncertain_end ? before_last_collision(scene, engine) : account.first_uncertain.time.value);
  if (!found) return;
  const std::string floor = collapsing_floor(scene);
  const bool on_floor =
      floor == "walls.left" ? found->particle < 0 : floor == "walls.right" && found->particle + 1 == engine.particles();
  outcome.report = collapse_report(*found, outcome.end, outcome.collisions) +
                   fmt::format("  to go past it  give {}{}\n",
                               on_floor ? floor + ".rest_speed" : "law.cutoff, or run.collapse = \"merge\"",
                               scene.run.stop_gap ? "; a smaller run.stop_gap follows it further" : "");
  outcome.collapse_time = (found->settled ? found->time : found->last_collision).text();
  collapse = collapse_tables(*found);
}

}  // namespace cradle::tools
