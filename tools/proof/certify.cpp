#include "cradle/tools/proof/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "cradle/precision/scalars.hpp"
#include "cradle/tools/model/laws.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/support/checksum.hpp"
#include "cradle/tools/support/threads.hpp"

namespace cradle::tools {

// Compiled once per type of midpoints, in a source of its own.
template <class M> std::unique_ptr<Certifier> certifier_in(const Scene& scene, unsigned digits);

std::unique_ptr<Certifier> certifier(const Scene& scene, unsigned digits) {
  if (digits == 31) return certifier_in<double_double>(scene, digits);
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(digits));
  if (Mpfr<4>::holds(digits)) return certifier_in<Mpfr<4>>(scene, digits);
  if (Mpfr<16>::holds(digits)) return certifier_in<Mpfr<16>>(scene, digits);
  if (Mpfr<56>::holds(digits)) return certifier_in<Mpfr<56>>(scene, digits);
#endif
  throw Error({}, "no balls of so many digits in this build", fmt::format("{}", digits),
              "install libmpfr-dev (Debian's name) and build again, or give at most 1000 digits");
}

std::vector<unsigned> rising_digits() {
#ifdef CRADLE_WITH_MPFR
  return {31, 50, 100, 200, 400, 800};
#else
  return {31};
#endif
}

std::optional<NotProvable> not_provable(const Scene& scene) {
  constexpr const char* compare_precisions = "compare precisions with `cradle trust` instead";
  if (scene.initial.type == InitialType::clusters)
    return {{"initial.type", "no collisions to prove", "clusters, a model", "give a scene of particles"}};
  if (!law_row(scene).provable)
    return {{"law.type", "no proof of this law", value_text(*find_field("law.type", scene), scene).value(),
             compare_precisions}};
  if (scene.walls.shaken())
    return {{scene.walls.left.shaken() ? "walls.left.motion" : "walls.right.motion", "shaken walls are not provable",
             "a shaken wall", compare_precisions}};
  if (const auto& left = scene.walls.left.rest_speed; left || scene.walls.right.rest_speed)
    return {{left ? "walls.left.rest_speed" : "walls.right.rest_speed", "rest on a wall is not provable",
             (left ? left : scene.walls.right.rest_speed)->text, compare_precisions}};
  // Between a particle that falls and a wall that it falls away from the gap is not concave (core/README.md).
  if (scene.gravity.acts())
    return {{"gravity.acceleration", "gravity is not provable", scene.gravity.acceleration->text, compare_precisions}};
  return {};
}

void check_certifiable(const Scene& scene) {
  check_built(scene);
  if (const auto reason = not_provable(scene))
    throw Error({"", 0, reason->key}, reason->what, reason->found, reason->instead);
}

namespace {

const char* question(Check check) {
  switch (check) {
  case Check::neighbours:
    return "those that meet are neighbours";
  case Check::closing:
    return "they approach each other: the second (closing speed) exceeds the first";
  case Check::later:
    return "they meet after the last collision of either: the second time exceeds the first";
  case Check::side:
    return "on which side of a threshold of the law they meet: first against second";
  case Check::gap:
    return "the gap between them is positive: the second exceeds the first";
  case Check::before:
    return "its last collision was before: the second time exceeds the first";
  case Check::agreement:
    return "the run has the number that is proved: first against second";
  }
  return "";
}

// Of the run that proposes collisions, where these were wrong.
bool raise(Scene& scene, unsigned digits) {
  switch (scene.run.precision) {
  case Precision::double_:
  case Precision::long_double:
    scene.run.precision = Precision::double_double;
    return true;
  case Precision::mpfr:
    return false;
  default:
#ifdef CRADLE_WITH_MPFR
    scene.run.precision = Precision::mpfr;
    scene.run.digits = std::max(digits, 50U);
    return true;
#else
    return digits > 1000;
#endif
  }
}

// Whether the proof ends at a collision that the run has made.
bool ends(Certifier& proof) {
  try {
    proof.check_all();
    return false;
  } catch (const ProofEnds&) {
    return true;
  }
}

std::string near(const std::string& number) { return number.size() > 24 ? number.substr(0, 24) + "..." : number; }

// The digits that both ends share, and how much is known; both ends where they do not share many.
std::string shown(const Enclosed& x) {
  const auto &low = x.decimals.low, &high = x.decimals.high;
  const auto end = std::min(low.find('e'), low.size());
  constexpr std::size_t least = 16, most = 60;
  const auto shared =
      static_cast<std::size_t>(std::mismatch(low.begin(), low.end(), high.begin(), high.end()).first - low.begin());
  if (shared < least || low.substr(end) != high.substr(std::min(high.find('e'), high.size())))
    return fmt::format("{} to {}", low, high);
  return fmt::format("{}...{} (known to {:.2g})", low.substr(0, std::min({shared, most, end})), low.substr(end),
                     x.radius);
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
  std::string text = fmt::format("{}: {} whether {}", where, d.refuted ? "it is not so" : "open", question(d.check));
  if (d.check != Check::neighbours)
    text += fmt::format(" ({}; {}; known to {:.2g})", near(d.first), near(d.second), d.width);
  return text;
}

std::string Certified::undecided() const {
  if (certificate.doubt) return doubt_text(*certificate.doubt);
  if (outcome.end != RunEnd::exhausted) return "";
  return fmt::format("from t = {} on, after {} collisions: the run ended there, before t = {} ({})",
                     certificate.samples.back().time_text, certificate.collisions, scene.run.until.text,
                     end_row(outcome.end).text);
}

std::string Certified::not_proved() const {
  if (certificate.doubt || outcome.end != RunEnd::collapsed) return "";
  return "that this is an inelastic collapse, and when it is complete; that is an estimate of the run, which ended at "
         "the last collision that is proved";
}

Certified certify(const Scene& requested, const CertifyOptions& options) {
  check_certifiable(requested);
  Scene scene = requested;
  std::vector<Attempt> attempts;
  // One of them checks what the others propose.
  const unsigned threads = thread_count(options.threads);
  const Threads of_run(std::max(threads, 2U) - 1);
  auto digits = options.digits.begin();
  // One number of digits per process: a run in MPFR and its balls have the same.
  const auto in_step = [&] {
    if (scene.run.precision != Precision::mpfr) return *digits;
    while (digits + 1 != options.digits.end() && *digits < scene.run.digits) ++digits;
    scene.run.digits = std::max<std::uint64_t>(scene.run.digits, *digits);
    return static_cast<unsigned>(scene.run.digits);
  };
  for (;;) {
    const auto started = std::chrono::steady_clock::now();
    const unsigned of_balls = in_step();
    const auto observer = options.make(scene, of_balls);
    if (threads > 1) observer->check_beside();
    RunOutcome outcome;
    try {
      outcome = run_scene(scene, {options.progress, observer.get(), options.interrupt, workers(of_run)});
    } catch (const ProofEnds&) {
    } catch (const Error& error) {  // a guard of the run: it was wrong, as if a collision of it had been
      const bool ended = ends(*observer);
      if (!ended && (error.status != Exit::lost || !raise(scene, of_balls))) throw;
      if (!ended) continue;
    }
    if (outcome.end == RunEnd::interrupted)
      throw Error({}, "interrupted", "", "run it again; nothing is kept of a proof that did not finish",
                  status_of_signal(options.interrupt->signal()));
    Certificate certificate = observer->certificate();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    const auto& samples = certificate.samples;
    attempts.push_back({precision_name(scene.run), certificate.digits_text, samples.empty() ? 0 : samples.back().time,
                        certificate.collisions, seconds, certificate.doubt ? doubt_text(*certificate.doubt) : ""});
    const bool last = digits + 1 == options.digits.end();
    // Collisions that are wrong require more digits of the run, those that are open more digits of the balls.
    const auto& doubt = certificate.doubt;
    const bool raised = doubt && doubt->refuted && raise(scene, of_balls);
    if (doubt && doubt->check == Check::agreement && last && !raised)
      throw Error(
          {}, "the proof and its run do not agree in any precision, so one of them is wrong", doubt_text(*doubt),
          "nothing of this can be called proved; report it as an error of the program, with the scene", Exit::lost);
    if (!doubt || (last && !raised))
      return {std::move(scene), std::move(outcome), std::move(certificate), std::move(attempts)};
    if (!raised) ++digits;
  }
}

std::string certificate_text(const Certified& run) {
  const Certificate& c = run.certificate;
  const double share = c.collisions == 0 ? 1 : static_cast<double>(c.in_doubles) / static_cast<double>(c.collisions);
  std::string text;
  if (run.proved())
    text = fmt::format("proved: {} collisions up to t = {} are those of the exact system, all of them and no other\n",
                       c.collisions, c.samples.back().time_text);
  else
    text = fmt::format("undecided {}\nproved up to there: {} collisions\n", run.undecided(), c.collisions);
  if (const std::string beyond = run.not_proved(); !beyond.empty()) text += fmt::format("not proved: {}\n", beyond);
  text += fmt::format("  scene     {}, checksum {:016x}\n", run.scene.name, crc64(effective_toml(run.scene)));
  text += fmt::format("  run in    {}, proved in balls around {}; {:.4g} % of collisions decided in plain doubles\n",
                      precision_name(run.scene.run), c.digits_text, 100 * share);
  if (!c.samples.empty()) {
    const CertainSample& last = c.samples.back();
    text += fmt::format("  energy    {} at t = {}\n", shown(last.energy), last.time_text);
    if (last.front_left) text += fmt::format("  fronts    {}\n", shown(*last.front_left));
    if (last.front_right) text += fmt::format("            {}\n", shown(*last.front_right));
    text += fmt::format("  margins   places known to 1e{:.1f}", last.widest);
    if (std::isfinite(last.least_gap))
      text += fmt::format(", smallest gap 1e{:.1f}, gaps known to 1e{:.1f} of themselves", last.least_gap,
                          last.widest_of_gap);
    text += '\n';
    for (const End end : {End::left, End::right})
      if (const auto& wall = last.walls[static_cast<std::size_t>(end)]) {
        const bool left = end == End::left;
        const WallAt& of = left ? run.scene.walls.left : run.scene.walls.right;
        text += fmt::format("  walls     {}: {} collisions", left ? "left" : "right", wall->collisions);
        if (of.temperature || of.speed != Decimal("0")) text += fmt::format(", energy given {}", shown(wall->given));
        text += '\n';
      }
    if (run.proved() && last.over)
      text += "  after it  no particles approach each other: there are no more collisions\n";
  }
  for (const Attempt& a : run.attempts)
    text += fmt::format("  {:.1f} s in {} and {}: {}\n", a.seconds, a.precision, a.digits,
                        a.doubt.empty() ? "proved" : a.doubt);
  return text;
}

namespace {

struct Bounds {
  std::vector<double> low, high;
  std::vector<std::string> low_text, high_text;

  void add(const std::optional<Enclosed>& x) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    low.push_back(x ? x->doubles.low : none), high.push_back(x ? x->doubles.high : none);
    low_text.push_back(x ? x->decimals.low : "nan"), high_text.push_back(x ? x->decimals.high : "nan");
  }
  void put(Group& doubles, Group& exact, const std::string& name, const std::string& unit,
           const std::string& what) const {
    doubles.columns.push_back({name + "_low", unit, "lower bound of the " + what + ", rounded down", low});
    doubles.columns.push_back({name + "_high", unit, "upper bound of the " + what + ", rounded up", high});
    exact.columns.push_back({name + "_low", unit, "lower bound of the " + what + ", all digits known", low_text});
    exact.columns.push_back({name + "_high", unit, "upper bound of the " + what + ", all digits known", high_text});
  }
};

}  // namespace

Result certified_result(Certified run) {
  const Certificate& c = run.certificate;
  Result result = std::move(run.outcome.result);
  if (c.doubt) result = {provenance(run.scene, precision_name(run.scene.run), end_row(RunEnd::undecided).text), {}};
  Group certificate{"certificate",
                    {{"verdict", run.proved() ? "proved" : "undecided"},
                     {"collisions", c.collisions},
                     {"undecided", run.undecided()},
                     {"proved_until", c.samples.empty() ? "" : c.samples.back().time_text},
                     {"not_proved", run.not_proved()},
                     {"precision", precision_name(run.scene.run)},
                     {"digits", std::uint64_t{c.digits}},
                     {"collisions_in_doubles", c.in_doubles},
                     {"over", std::uint64_t{run.proved() && !c.samples.empty() && c.samples.back().over}},
                     {"scene_checksum", fmt::format("{:016x}", crc64(effective_toml(run.scene)))}},
                    {}};
  Group of_series{"series", {}, {}}, exact{"exact/series", {}, {}};
  std::vector<double> time, sampled, widest, gap, of_gap;
  std::vector<std::string> time_text;
  std::vector<std::uint64_t> collisions;
  Bounds energy, left, right;
  std::array<Bounds, 2> given, lost;
  for (const CertainSample& s : c.samples) {
    time.push_back(s.time), collisions.push_back(s.collisions);
    widest.push_back(s.widest), gap.push_back(s.least_gap), of_gap.push_back(s.widest_of_gap);
    if (!s.of_series) continue;
    sampled.push_back(s.time), time_text.push_back(s.time_text);
    energy.add(s.energy), left.add(s.front_left), right.add(s.front_right);
    for (std::size_t k = 0; k < s.walls.size(); ++k)
      if (const auto& wall = s.walls[k]) given[k].add(wall->given), lost[k].add(wall->lost);
  }
  exact.columns.push_back({"time", "t", "of the sample", time_text});
  certificate.columns = {{"time", "t", "up to which the run is proved", time},
                         {"collisions", "1", "proved until then", collisions},
                         {"widest", "1", "largest radius of a place in l, as a power of ten", widest},
                         {"gap", "1", "smallest gap in l, as a power of ten", gap},
                         {"widest_of_gap", "1", "largest radius of a gap against the gap, as a power of ten", of_gap}};
  const auto own = std::find_if(result.groups.begin(), result.groups.end(),
                                [](const Group& group) { return group.name == "series"; });
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
