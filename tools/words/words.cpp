#include "cradle/tools/words/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <sstream>

#include "cradle/core/words/ranges.hpp"
#include "cradle/precision/ball.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

using words::Condition;
using words::Verdict;
using words::Within;

WordParticles word_particles(const std::string& count, const std::string& masses, const std::string& walls,
                             unsigned digits) {
  WordParticles all;
  all.digits = digits;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), all.particles);
  if (error != std::errc{} || end != count.data() + count.size() || all.particles < 3 || all.particles > 6)
    throw Error({"", 0, "N"}, "not a number of particles that words are built for", count, "give 3, 4, 5 or 6");
  if (!masses.empty()) {
    std::istringstream list(masses);
    for (std::string item; std::getline(list, item, ',');) {
      try {
        all.masses.emplace_back(checked_literal(item));
      } catch (const std::invalid_argument&) {
        throw Error({"", 0, "--masses"}, "not a mass", item, "give numbers above 0, with commas between");
      }
      if (!(all.masses.back() > Decimal("0")))
        throw Error({"", 0, "--masses"}, "not a mass", item, "give numbers above 0, with commas between");
    }
    if (all.masses.size() != all.particles)
      throw Error({"", 0, "--masses"}, "not one mass per particle",
                  fmt::format("{} for {} particles", all.masses.size(), all.particles),
                  fmt::format("give {} numbers, with commas between", all.particles));
  }
  if (walls != "" && walls != "left" && walls != "right" && walls != "both")
    throw Error({"", 0, "--walls"}, "no such walls", walls, "give left, right or both");
  all.left_wall = walls == "left" || walls == "both";
  all.right_wall = walls == "right" || walls == "both";
  return all;
}

namespace {

constexpr std::size_t points = 1999;  // of the grid on which restitutions are looked at
constexpr long double tolerance = 1e-11L;

// What a margin says, where it is 0.
std::string equality_text(const words::Word& word, const std::vector<Condition>& conditions, std::size_t margin) {
  const auto collision = [&](std::size_t place) {
    return fmt::format("collision {} ({})", place + 1, static_cast<char>('a' + word[place]));
  };
  if (margin + 1 >= conditions.size())
    return margin + 1 == conditions.size() ? "closing speeds no longer shrink" : "periods no longer become shorter";
  const Condition& c = conditions[margin];
  if (c.of == Condition::Of::closing) return fmt::format("the closing speed of {} is 0", collision(c.first));
  return fmt::format("three particles meet: {}{} at the time of {}", collision(c.second),
                     c.next_period ? " of the next period" : "", collision(c.first));
}

std::string list_of(const std::vector<std::string>& items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i > 0 ? ", " : "") + items[i];
  return text + ']';
}

// The analysis in one type of numbers.
template <class T> class Analyst {
  using B = Ball<T>;

 public:
  Analyst(const WordParticles& particles, const words::Word& word)
      : particles_(particles), quick_(word, shares_in<long double>(particles)),
        runs_(words::scan(quick_, points, tolerance)) {}

  bool any() const {
    return std::any_of(runs_.begin(), runs_.end(), [](const auto& run) { return run.verdict != Verdict::none; });
  }

  WordReport report(const std::optional<Decimal>& at) {
    WordReport report;
    report.word = report.in_order = words::text_of(quick_.word);
    for (const words::Run& run : runs_)
      if (run.verdict == Verdict::degenerate) report.degenerate = degenerate_text(run);
    const auto first =
        std::find_if(runs_.begin(), runs_.end(), [](const auto& run) { return run.verdict == Verdict::exists; });
    if (first == runs_.end()) return report;
    const long double middle = words::grid_point<long double>((first->first + first->last) / 2, points);
    quick_ = words::in_order_of_time(quick_, middle, tolerance,
                                     particles_.symmetric() ? words::Begin::longest_or_half : words::Begin::longest);
    report.in_order = words::text_of(quick_.word);
    report.mirrored = quick_.period.mirrored;
    const words::Prover<B, T> prover(quick_.word, shares_in<T>(particles_), shares_in<B>(particles_), report.mirrored);
    // Two digits more than are printed.
    const T radius = from_text<T>(fmt::format("1e-{}", particles_.digits + 2));
    for (const auto& range : words::ranges(prover, quick_, runs_, points, tolerance, radius))
      report.ranges.push_back(text_of(prover, range, radius, at));
    return report;
  }

 private:
  std::string degenerate_text(const words::Run& run) const {
    const words::System<T> system(quick_.word, shares_in<T>(particles_));
    const T r = words::grid_point<T>((run.first + run.last) / 2, points), none = from_text<T>("1e-50");
    const auto found = words::find(system, r, none);
    if (found.verdict != Verdict::degenerate) return "";
    const auto margins = words::margins(system, r, found.pairs);
    for (std::size_t k = 0; k < margins.size(); ++k)
      if (!(margins[k].value > none * margins[k].scale))
        return fmt::format("at r = {:.4g} {}, to 50 digits", to_double(r),
                           equality_text(quick_.word, system.conditions, k));
    return "";
  }

  bool is_stable(long double r) const {
    const auto found = words::find(quick_, r, tolerance);
    if (found.verdict != Verdict::exists) return false;
    const auto [speeds, gaps] = words::others(quick_, r, found.pairs);
    return words::largest_modulus(speeds) < 1 && words::largest_modulus(gaps) < 1;
  }

  // Ends are bisected between the points of a grid, except for those of the range itself.
  std::vector<std::pair<double, double>> stable_ranges(double low, double high) const {
    constexpr int steps = 256;
    const auto at = [&](int k) {
      return static_cast<long double>(low) + static_cast<long double>(high - low) * (k + 0.5L) / steps;
    };
    const auto change = [&](long double yes, long double no) {
      for (int i = 0; i < 40; ++i) {
        const long double middle = (yes + no) / 2;
        (is_stable(middle) ? yes : no) = middle;
      }
      return static_cast<double>(yes);
    };
    std::vector<std::pair<double, double>> all;
    bool before = false;
    for (int k = 0; k < steps; ++k) {
      const bool here = is_stable(at(k));
      if (here && !before) all.emplace_back(k == 0 ? low : change(at(k), at(k - 1)), high);
      if (!here && before) all.back().second = change(at(k - 1), at(k));
      before = here;
    }
    return all;
  }

  WordEnd text_of(const words::System<T>& system, const words::End<T>& end, bool proved, const T& radius) const {
    using Is = typename words::End<T>::Is;
    WordEnd text;
    text.value = to_double(end.at);
    text.proved = proved;
    text.at = end.is == Is::zero ? "0" : cut_off(to_text(end.at), particles_.digits);
    const auto around = in_decimals(B::widened(B(end.at, 0), B(radius, 0).size()));
    text.low = end.is == Is::zero ? "0" : around.low;
    text.high = end.is == Is::zero ? fmt::format("1e-{}", particles_.digits + 2) : around.high;
    if (end.is == Is::zero) text.reason = "no restitution is smaller";
    if (end.is == Is::meeting) text.reason = "two eigenvalues of the velocity map meet, and are complex beyond";
    if (end.is == Is::unresolved) text.reason = "not resolved";
    if (end.is == Is::equality) text.reason = equality_text(system.word, system.conditions, end.margin);
    return text;
  }

  WordRange text_of(const words::Prover<B, T>& prover, const words::Range<T>& range, const T& radius,
                    const std::optional<Decimal>& at) const {
    WordRange text;
    text.low = text_of(prover.system, range.low, range.low_ends, radius);
    text.high = text_of(prover.system, range.high, range.high_ends, radius);
    text.proved_from = to_text(range.proved_low), text.proved_to = to_text(range.proved_high);
    const bool to_low = !(range.low.at + radius * T(2) < range.proved_low);
    const bool to_high = !(range.proved_high < range.high.at - radius * T(2));
    text.proved = text.low.proved && text.high.proved && to_low && to_high;
    text.balls = range.balls;

    T r = range.middle;
    words::Pairs<T> pairs = range.pairs;
    if (at) {
      r = from_text<T>(at->text);
      const auto found = words::find(prover.system, r, T(0));
      if (found.verdict != Verdict::exists)
        throw Error({"", 0, "--at"}, "no such state at this restitution", at->text,
                    fmt::format("give one between {} and {}", text.low.at, text.high.at));
      pairs = found.pairs;
    }
    pairs = words::followed(prover.system, r, pairs);
    const auto state = words::state_of(prover.system, pairs);
    text.at = at ? at->text : fmt::format("{}", to_double(r));
    text.lambda = to_double(state.lambda);
    text.gamma = to_double(T(T(1) / state.growth));
    const auto stable = words::stability(prover, r, pairs);
    text.factor = to_double(stable.factor);
    text.stable = stable.within == Within::yes  ? "stable, proved"
                  : stable.within == Within::no ? "unstable, proved"
                  : stable.factor < T(1)        ? "stable"
                                                : "unstable";
    text.stable_ranges = stable_ranges(text.low.value, text.high.value);
    text.start = start_text(particles_, prover.system, r, pairs, particles_.digits + 5);
    return text;
  }

  const WordParticles& particles_;
  words::System<long double> quick_;
  std::vector<words::Run> runs_;
};

// Four times as many digits as are proved: for the smallest eigenvalues, and for steps of Newton's method.
template <class Found, class F> Found in_digits(unsigned digits, [[maybe_unused]] F f) {
#ifdef CRADLE_WITH_MPFR
  MpfrPrecision::set_bits(MpfrPrecision::bits_for(4 * digits));
  if (Mpfr<8>::holds(4 * digits)) return f(std::type_identity<Mpfr<8>>{});
  if (Mpfr<56>::holds(4 * digits)) return f(std::type_identity<Mpfr<56>>{});
#endif
  throw Error({"", 0, "--digits"}, "no balls of so many digits in this build", fmt::format("{}", 4 * digits),
              "install libmpfr-dev (Debian's name) and build again, or give at most 250 digits");
}

double seconds_since(std::chrono::steady_clock::time_point started) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

}  // namespace

WordReport report_word(const WordParticles& particles, const words::Word& word, const std::optional<Decimal>& at) {
  WordReport report;
  report.word = report.in_order = words::text_of(word);
  if (particles.left_wall && particles.right_wall) return report;
  const auto started = std::chrono::steady_clock::now();
  report = in_digits<WordReport>(
      particles.digits, [&]<class T>(std::type_identity<T>) { return Analyst<T>(particles, word).report(at); });
  report.word = words::text_of(word);
  report.seconds = seconds_since(started);
  return report;
}

std::vector<WordReport> search_words(const WordParticles& particles, std::size_t longest,
                                     const std::function<void(const WordReport&)>& found, std::size_t& tried) {
  if (particles.left_wall && particles.right_wall) return {};  // all gaps together are as long as they were
  return in_digits<std::vector<WordReport>>(particles.digits, [&]<class T>(std::type_identity<T>) {
    std::vector<WordReport> all;
    words::for_each_word(particles.gaps(), longest, particles.symmetric(), [&](const words::Word& word) {
      ++tried;
      const auto started = std::chrono::steady_clock::now();
      Analyst<T> analyst(particles, word);
      if (!analyst.any()) return;
      all.push_back(analyst.report({}));
      all.back().word = words::text_of(word);
      all.back().seconds = seconds_since(started);
      found(all.back());
    });
    return all;
  });
}

namespace {

std::string proof_text(const WordRange& range) {
  if (range.proved) return "proved";
  std::string text =
      fmt::format("proved from {:.12g} to {:.12g}", std::stod(range.proved_from), std::stod(range.proved_to));
  if (!range.low.proved) text += ", not that the lower end is one";
  if (!range.high.proved) text += ", not that the upper end is one";
  return text;
}

const char* const two_walls =
    "nowhere: the distance between two walls at rest is the sum of all gaps, which therefore cannot all shrink\n";

}  // namespace

std::string word_text(const WordParticles& particles, const WordReport& report) {
  std::string text = fmt::format("{}: {}\n", report.word, particles.text());
  if (particles.left_wall && particles.right_wall) return text + two_walls;
  if (report.in_order != report.word) text += fmt::format("  in order of time  {}\n", report.in_order);
  if (report.mirrored) text += "  symmetry          the second half is the mirror image of the first\n";
  if (!report.degenerate.empty()) text += fmt::format("  degenerate        {}\n", report.degenerate);
  if (report.ranges.empty())
    return text +
           fmt::format("  exists            at none of {} restitutions between 0 and 1 (seen, not proved)\n", points);
  for (const WordRange& range : report.ranges) {
    text += fmt::format("  exists            for r from {} to {}\n", range.low.at, range.high.at);
    text += fmt::format("  existence         {}\n", proof_text(range));
    for (const auto& [name, end] : {std::pair("lower", &range.low), std::pair("upper", &range.high)})
      text += fmt::format("  {} end         {} ({})\n", name, end->reason, end->proved ? "proved" : "not proved");
    text += fmt::format("  at r = {}\n", range.at);
    text += fmt::format("    a period        multiplies speeds by {:.10g}, gaps by {:.10g}, times by {:.10g}\n",
                        range.lambda, range.gamma, range.gamma / range.lambda);
    text +=
        fmt::format("    stability       {}: a perturbation grows by {:.6g} in a period\n", range.stable, range.factor);
    for (const auto& [from, to] : range.stable_ranges)
      text += fmt::format("    stable          for r from {:.10g} to {:.10g} (seen, not proved)\n", from, to);
    for (std::size_t i = 0; i < range.start.gaps.size(); ++i)
      text += fmt::format("    gap {}           {}, closing speed {}\n", static_cast<char>('a' + i),
                          range.start.gaps[i], range.start.speeds[i]);
    text += fmt::format("    collapse        at t = {}\n", range.start.collapse);
  }
  text += fmt::format("  not proved: that there are no others, narrower than a step of {:.1g}, or outside\n",
                      1.0 / (points + 1));
  return text;
}

namespace {

std::string stable_text(const WordRange& range) {
  std::string text;
  for (const auto& [from, to] : range.stable_ranges)
    text += fmt::format("{}{:.8f}..{:.8f}", text.empty() ? "" : ", ", from, to);
  return text.empty() ? "nowhere" : text;
}

}  // namespace

std::string word_line(const WordReport& report) {
  std::string text;
  for (const WordRange& range : report.ranges)
    text += fmt::format("{:<14} {:<18} {:.18}  {:<9} {:<23}  {}\n", report.word,
                        range.low.at == "0" ? "0" : range.low.at.substr(0, 18), range.high.at,
                        range.proved ? "proved" : "in part", stable_text(range), range.high.reason);
  if (!report.degenerate.empty()) text += fmt::format("{:<14} degenerate: {}\n", report.word, report.degenerate);
  return text;
}

Result words_result(const WordParticles& particles, const std::vector<WordReport>& reports, std::size_t tried,
                    const std::string& command) {
  // The scene is the state of the first word, so that the file can be run.
  std::string scene = "title = \"words of collapse\"\n[law]\ntype = \"inelastic\"\nrestitution = 0.05\n[initial]\n"
                      "type = \"list\"\nx = [0, 1]\nv = [0, 0]\n[run]\nuntil = 1\n";
  for (const WordReport& report : reports) {
    if (report.ranges.empty()) continue;
    const WordRange& range = report.ranges.front();
    scene = fmt::format("title = \"{} {}\"\n[law]\ntype = \"inelastic\"\nrestitution = {}\n"
                        "[initial]\ntype = \"list\"\nx = {}\nv = {}\n",
                        reports.size() == 1 ? "self-similar collapse" : "words of collapse, the first:", report.word,
                        range.at, list_of(range.start.x), list_of(range.start.v));
    if (!particles.masses.empty()) {
      std::vector<std::string> masses;
      for (const Decimal& mass : particles.masses) masses.push_back(mass.text);
      scene += "m = " + list_of(masses) + '\n';
    }
    for (const auto& [is, name, place] : {std::tuple(particles.left_wall, "left", std::string("0")),
                                          std::tuple(particles.right_wall, "right", std::string("1"))})
      if (is) scene += fmt::format("[walls.{}]\nposition = {}\nrestitution = {}\n", name, place, range.at);
    scene += fmt::format("[run]\nuntil = {}\nprecision = \"mpfr\"\ndigits = {}\n", range.start.collapse,
                         std::max(particles.digits, 10U));
    break;
  }
  Result result;
  result.attributes = provenance(parse_scene(scene, "words.toml"), fmt::format("mpfr, {} digits", 4 * particles.digits),
                                 "words of collapse");
  result.attributes.emplace_back("kind", std::string("words"));
  std::vector<std::string> word, low_text, high_text, low_reason, high_reason, stable, gaps, speeds, at_text;
  std::vector<double> low, high, from, to, at, lambda, gamma, factor, stable_from, stable_to;
  std::vector<std::uint64_t> proved, low_proved, high_proved;
  for (const WordReport& report : reports)
    for (const WordRange& range : report.ranges) {
      word.push_back(report.word);
      low.push_back(range.low.value), high.push_back(range.high.value);
      low_text.push_back(range.low.at), high_text.push_back(range.high.at);
      from.push_back(std::stod(range.proved_from)), to.push_back(std::stod(range.proved_to));
      proved.push_back(range.proved), low_proved.push_back(range.low.proved);
      high_proved.push_back(range.high.proved);
      low_reason.push_back(range.low.reason), high_reason.push_back(range.high.reason);
      at.push_back(std::stod(range.at)), at_text.push_back(range.at);
      lambda.push_back(range.lambda), gamma.push_back(range.gamma), factor.push_back(range.factor);
      stable.push_back(range.stable);
      const auto& stables = range.stable_ranges;
      stable_from.push_back(stables.empty() ? std::nan("") : stables.front().first);
      stable_to.push_back(stables.empty() ? std::nan("") : stables.front().second);
      gaps.push_back(list_of(range.start.gaps)), speeds.push_back(list_of(range.start.speeds));
    }
  const std::string end = "; proved to be within 1e-" + std::to_string(particles.digits) + " where ";
  result.groups.push_back(
      {"words",
       {{"particles", std::uint64_t{particles.particles}},
        {"system", particles.text()},
        {"tried", std::uint64_t{tried}},
        {"command", command},
        {"digits", std::uint64_t{particles.digits}}},
       {{"word", "1", "letters are gaps from the left", word},
        {"low", "1", "lower end of the restitutions for which the self-similar state exists", low},
        {"high", "1", "upper end", high},
        {"low_digits", "1", "lower end, decimals cut off" + end + "low_proved is 1", low_text},
        {"high_digits", "1", "upper end, decimals cut off" + end + "high_proved is 1", high_text},
        {"proved", "1", "1: existence is proved up to both ends, and that they are ends", proved},
        {"low_proved", "1", "1: it is proved that the state ends there", low_proved},
        {"high_proved", "1", "1: it is proved that the state ends there", high_proved},
        {"proved_from", "1", "existence is proved from this restitution on (rounded to a double)", from},
        {"proved_to", "1", "existence is proved up to this restitution (rounded to a double)", to},
        {"low_reason", "1", "what ends it below", low_reason},
        {"high_reason", "1", "what ends it above", high_reason},
        {"at", "1", "the restitution of what follows", at},
        {"lambda", "1", "by what a period multiplies closing speeds", lambda},
        {"gamma", "1", "by what a period multiplies gaps", gamma},
        {"factor", "1", "by what a period multiplies a small perturbation", factor},
        {"stable", "1", "whether that is below 1", stable},
        {"stable_from", "1", "the first range where the state is stable, as seen on a grid; NaN: none", stable_from},
        {"stable_to", "1", "end of that range", stable_to},
        {"gaps", "1", "of the state half-way to the first collision; their sum is 1", gaps},
        {"closing_speeds", "1", "of that state; the largest one is 1", speeds}}});
  return result;
}

}  // namespace cradle::tools
