// What a proof says: as text, and as groups of a result.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cradle/tools/proof/certify.hpp"
#include "cradle/tools/support/bytes.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

namespace {

struct CheckText {
  Check type;
  const char* text;
};
constexpr CheckText check_texts[] = {
    {Check::neighbours, "those that meet are neighbours"},
    {Check::closing, "they approach each other: the second (closing speed) exceeds the first"},
    {Check::later, "they meet after the last collision of either: the second time exceeds the first"},
    {Check::side, "on which side of a threshold of the law they meet: first against second"},
    {Check::gap, "the gap between them is positive: the second exceeds the first"},
    {Check::before, "its last collision was before: the second time exceeds the first"},
    {Check::agreement, "the run has the number that is proved: first against second"},
    {Check::reaches, "it falls on the wall: the square of its speed there, the second, exceeds the first"},
    {Check::turns, "the gap stays open between two collisions under gravity: the second exceeds the first"},
};
static_assert(rows_in_order(check_texts));

std::string near(const std::string& number) { return number.size() > 24 ? number.substr(0, 24) + "..." : number; }

// That of the last collision has all digits of the proof.
std::string shown_time(const std::string& time) {
  constexpr std::size_t most = 40;
  if (time.size() <= most) return time;
  const auto end = std::min(time.find('e'), time.size());
  return time.substr(0, std::min(end, most)) + "..." + time.substr(end);
}

// The digits that both ends share, and how much is known. Both ends where they do not share many, unless that is
// because a shorter number is between them, as 9.1 between 9.09999999999999999 and 9.10000000000000001: then that one.
std::string shown(const Enclosed& x) {
  const auto &low = x.decimals.low, &high = x.decimals.high;
  const auto end = std::min(low.find('e'), low.size());
  constexpr std::size_t least = 16, most = 60;
  const auto shared =
      static_cast<std::size_t>(std::mismatch(low.begin(), low.end(), high.begin(), high.end()).first - low.begin());
  if (shared == 0 || low.substr(end) != high.substr(std::min(high.find('e'), high.size())) ||
      (shared < least && !(x.radius < 1e-15L * std::abs(x.doubles.high))))
    return fmt::format("{} to {}", shown_time(low), shown_time(high));
  const std::string begin = shared < least ? (low.front() == '-' ? low : high).substr(0, shared + 1)
                                           : low.substr(0, std::min({shared, most, end})) + "...";
  return fmt::format("{}{} (known to {:.2g})", begin, low.substr(end), x.radius);
}

// 10^x in two digits, also below the range of double.
std::string power_of_ten(double x) {
  if (!(std::abs(x) > 300) || std::isinf(x)) return fmt::format("{:.2g}", std::pow(10, x));
  return fmt::format("{:.1f}e{:.0f}", std::pow(10, x - std::floor(x)), std::floor(x));
}

// Tables of a run that no proof encloses: they are sums over what is proved, but rounded by the run alone; or a
// snapshot at a time that is not proved, or at the end by a collapse.
std::vector<std::string> of_run_alone(const Result& result, const Certificate& certificate) {
  std::vector<std::string> names;
  for (const Group& group : result.groups) {
    std::string name = group.name.substr(0, group.name.find('/'));
    if (name == "series" || name == "events" || name == "exact") continue;
    if (name == "snapshots") {
      if (std::ranges::count(certificate.snapshots, "certificate/" + group.name, &Group::name) > 0) continue;
      name = group.name;
    }
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return names;
}

}  // namespace

std::string doubt_text(const ReportedDoubt& d) {
  std::string where = fmt::format("at t = {:.17g}, after {} collisions", d.time, d.collisions);
  if (d.check == Check::agreement)
    return fmt::format("{}: the run's {} is not what is proved of it ({}; {}; its rounding explains {:.2g})", where,
                       d.quantity, near(d.first), near(d.second), d.width);
  if (d.left >= 0)
    where += d.left == d.right ? fmt::format(", particle {}", d.left)
                               : fmt::format(", particles {} and {}", d.left, d.right);
  std::string text = fmt::format("{}: {} whether {}", where, d.refuted ? "it is not so" : "open",
                                 check_texts[static_cast<std::size_t>(d.check)].text);
  if (d.check != Check::neighbours)
    text += fmt::format(" ({}; {}; known to {:.2g})", near(d.first), near(d.second), d.width);
  return text;
}

std::string Certified::undecided() const {
  if (certificate.doubt) return doubt_text(*certificate.doubt);
  if (outcome.end != RunEnd::exhausted) return "";
  return fmt::format("from t = {} on, after {} collisions: the run ended there, before t = {} ({})",
                     shown_time(certificate.samples.back().time_text), certificate.collisions, scene.run.until.text,
                     end_row(outcome.end).text);
}

std::string Certified::not_proved() const {
  std::vector<std::string> all;
  if (!certificate.doubt && outcome.end == RunEnd::collapsed)
    all.push_back(
        "that infinitely many collisions follow, complete at the run's t_c to within its bound: of that there "
        "is a theorem (core/engine/README.md), which this proof does not check");
  if (!certificate.doubt && outcome.end == RunEnd::unproved)
    all.push_back("that this is an inelastic collapse, and when it is complete; that is an estimate of the run, which "
                  "ended at the last collision that is proved");
  if (const auto& open = certificate.open_samples; !open.empty()) {
    constexpr std::size_t most = 6;
    std::vector<std::string> named;
    for (const std::string& time : std::span(open).first(std::min(open.size(), most)))
      named.push_back(shown_time(time));
    all.push_back(fmt::format("what the rows at t = {}{} say: collisions fall there, and whether just before or just "
                              "after is open",
                              fmt::join(named, ", "),
                              open.size() > most ? fmt::format(" and {} more times", open.size() - most) : ""));
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

std::string certificate_text(const Certified& run) {
  const Certificate& c = run.certificate;
  const double share = c.collisions == 0 ? 1 : static_cast<double>(c.in_doubles) / static_cast<double>(c.collisions);
  std::string text;
  if (run.proved())
    text = fmt::format("proved: {} collisions up to t = {} are those of the exact system, all of them and no other\n",
                       c.collisions, shown_time(c.samples.back().time_text));
  else
    text = fmt::format("undecided {}\nproved up to there: {} collisions\n", run.undecided(), c.collisions);
  const auto& limits = run.scene.run;
  if (c.doubt && stops_at_collapse(run.scene) && limits.precision == Precision::mpfr && !limits.stop_gap)
    text += "to decide it, if it is a collapse: give run.stop_gap a gap at which the run ends, 1e-100 say (with more "
            "digits the run follows a collapse further)\n";
  if (const std::string beyond = run.not_proved(); !beyond.empty()) text += fmt::format("not proved: {}\n", beyond);
  text += fmt::format("  scene     {}, checksum {:016x}\n", run.scene.name, crc64(effective_toml(run.scene)));
  text += fmt::format(
      "  run in    {}, proved with error bounds in {}; {:.4g} % of collisions decided with those in doubles\n",
      precision_name(run.scene.run), c.digits_text, 100 * share);
  if (!c.samples.empty()) {
    const CertainSample& last = c.samples.back();
    text += fmt::format("  energy    {} at t = {}\n", shown(last.energy), shown_time(last.time_text));
    if (last.front_left) text += fmt::format("  fronts    {}\n", shown(*last.front_left));
    if (last.front_right) text += fmt::format("            {}\n", shown(*last.front_right));
    text += fmt::format("  margins   positions known to within {}", power_of_ten(last.widest));
    if (std::isfinite(last.least_gap))
      text += fmt::format(", smallest gap {}, every gap known to within {} of itself", power_of_ten(last.least_gap),
                          power_of_ten(last.widest_of_gap));
    text += '\n';
    for (const End end : {End::left, End::right})
      if (const auto& wall = last.walls[static_cast<std::size_t>(end)]) {
        const bool left = end == End::left;
        const WallAt& of = left ? run.scene.walls.left : run.scene.walls.right;
        text += fmt::format("  walls     {}: {} collisions", left ? "left" : "right", wall->collisions);
        if (of.temperature || of.speed != Decimal("0")) text += fmt::format(", energy given {}", shown(wall->given));
        text += '\n';
      }
    if (const auto alone = of_run_alone(run.outcome.result, c); run.proved() && !alone.empty())
      text +=
          fmt::format("  no bounds for {}: numbers of the run, computed from what is proved\n", fmt::join(alone, ", "));
    if (run.proved() && last.over)
      text += "  after it  no particles approach each other: there are no more collisions\n";
  }
  return text;
}

std::string attempts_text(const Certified& run) {
  std::string text;
  for (const Attempt& a : run.attempts)
    text += fmt::format("  {:.1f} s in {} and {}: {}\n", a.seconds, a.precision, a.digits,
                        !a.doubt.empty() ? a.doubt
                        : run.proved()   ? "proved"
                                         : "proved up to where the run ended");
  return text;
}

void Bounds::add(const std::optional<Enclosed>& x) {
  low.push_back(x ? x->doubles.low : none()), high.push_back(x ? x->doubles.high : none());
  low_text.push_back(x ? x->decimals.low : "nan"), high_text.push_back(x ? x->decimals.high : "nan");
}

void Bounds::put(Group& doubles, Group& exact, const std::string& name, const std::string& unit,
                 const std::string& what) const {
  doubles.columns.push_back({name + "_low", unit, "lower bound of the " + what + ", rounded down", low});
  doubles.columns.push_back({name + "_high", unit, "upper bound of the " + what + ", rounded up", high});
  exact.columns.push_back({name + "_low", unit, "lower bound of the " + what + ", all digits known", low_text});
  exact.columns.push_back({name + "_high", unit, "upper bound of the " + what + ", all digits known", high_text});
}

Result certified_result(Certified run) {
  const Certificate& c = run.certificate;
  Result result = c.doubt ? Result() : std::move(run.outcome.result);
  const RunEnd end = c.doubt ? RunEnd::undecided : run.outcome.end;
  std::vector<Attribute> attributes = provenance(run.scene, precision_name(run.scene.run), end_row(end).text);
  append(attributes, std::move(result.attributes));
  result.attributes = std::move(attributes);
  Group certificate{"certificate",
                    {{"verdict", run.proved() ? "proved" : "undecided"},
                     {"collisions", c.collisions},
                     {"undecided", run.undecided()},
                     {"proved_until", c.samples.empty() ? "" : c.samples.back().time_text},
                     {"not_proved", run.not_proved()},
                     {"of_run_alone", fmt::format("{}", fmt::join(of_run_alone(result, c), ", "))},
                     {"precision", precision_name(run.scene.run)},
                     {"digits", std::uint64_t{c.digits}},
                     {"collisions_in_doubles", c.in_doubles},
                     {"over", std::uint64_t{run.proved() && !c.samples.empty() && c.samples.back().over}},
                     {"scene_checksum", fmt::format("{:016x}", crc64(effective_toml(run.scene)))}},
                    {}};
  Group of_series{"series", {}, {}}, exact{"exact/series", {}, {}};
  std::vector<double> sampled;
  std::vector<std::string> time_text;
  Bounds energy, left, right;
  std::array<Bounds, 2> given, lost;
  for (const CertainSample& s : c.samples) {
    if (!s.of_series) continue;
    sampled.push_back(s.time), time_text.push_back(s.time_text);
    energy.add(s.energy), left.add(s.front_left), right.add(s.front_right);
    for (std::size_t k = 0; k < s.walls.size(); ++k)
      if (const auto& wall = s.walls[k]) given[k].add(wall->given), lost[k].add(wall->lost);
  }
  exact.columns.push_back({"time", "t", "of the sample", time_text});
  const auto of_samples = [&](auto of) { return numbers_of(c.samples, of); };
  certificate.columns = {
      {"time", "t", "up to which the run is proved", of_samples(&CertainSample::time)},
      {"collisions", "1", "proved until then", of_samples(&CertainSample::collisions)},
      {"widest", "1", "largest radius of a place in l, as a power of ten", of_samples(&CertainSample::widest)},
      {"gap", "1", "smallest gap in l, as a power of ten", of_samples(&CertainSample::least_gap)},
      {"widest_of_gap", "1", "largest radius of a gap against the gap, as a power of ten",
       of_samples(&CertainSample::widest_of_gap)}};
  const auto own = std::ranges::find(result.groups, "series", &Group::name);
  // Samples that a collision falls upon are not proved: the bounds then have rows of their own.
  const bool joined = own != result.groups.end() && own->columns.front().rows() == sampled.size();
  if (!joined)
    of_series = {
        own == result.groups.end() ? "series" : "certificate/series", {}, {{"time", "t", "of the sample", sampled}}};
  Group& doubles = joined ? *own : of_series;
  const char* const of_energy = "m l^2/t^2";
  const std::string front = "position of the outermost particle that has collided";
  energy.put(doubles, exact, "energy", of_energy, "kinetic energy");
  left.put(doubles, exact, "front_left", "l", front);
  right.put(doubles, exact, "front_right", "l", front);
  for (std::size_t k = 0; k < given.size(); ++k) {
    const std::string which = k == 0 ? "left" : "right";
    const WallAt& wall = k == 0 ? run.scene.walls.left : run.scene.walls.right;
    if (!wall.position) continue;
    given[k].put(doubles, exact, "wall_" + which + "_energy", of_energy,
                 "energy that the " + which + " wall has given");
    if (wall.dissipates())
      lost[k].put(doubles, exact, "wall_" + which + "_lost", of_energy, "energy lost in the " + which + " wall");
  }
  result.groups.push_back(std::move(exact));
  result.groups.push_back(std::move(certificate));
  if (!joined) result.groups.push_back(std::move(of_series));
  for (Group& snapshot : run.certificate.snapshots) result.groups.push_back(std::move(snapshot));
  return result;
}

}  // namespace cradle::tools
