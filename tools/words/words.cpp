#include "cradle/tools/words/words.hpp"
#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "cradle/precision/text.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

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
      all.masses.emplace_back(plain_decimal(item).value_or("0"));
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

std::string stable_text(const WordRange& range) {
  std::string text;
  for (const auto& [from, to] : range.stable_ranges)
    text += fmt::format("{}{:.8f}..{:.8f}", text.empty() ? "" : ", ", from, to);
  return text.empty() ? "nowhere" : text;
}

std::string list_of(const std::vector<std::string>& items) { return fmt::format("[{}]", fmt::join(items, ", ")); }

// A scene on the state of the first word that has one, so that the file can be run.
std::string scene_of(const WordParticles& particles, const std::vector<WordReport>& reports) {
  for (const WordReport& report : reports) {
    if (report.ranges.empty()) continue;
    const WordRange& range = report.ranges.front();
    std::string scene =
        fmt::format("title = \"{} {}\"\n[law]\ntype = \"inelastic\"\nrestitution = {}\n"
                    "[initial]\ntype = \"list\"\nx = {}\nv = {}\n",
                    reports.size() == 1 ? "self-similar collapse" : "words of collapse, the first:", report.word,
                    range.at, list_of(range.start.x), list_of(range.start.v));
    if (!particles.masses.empty()) scene += "m = " + list_of(numbers_of(particles.masses, &Decimal::text)) + '\n';
    for (const auto& [is, wall] :
         {std::pair(particles.left_wall, "left]\nposition = 0"), {particles.right_wall, "right]\nposition = 1"}})
      if (is) scene += fmt::format("[walls.{}\nrestitution = {}\n", wall, range.at);
    return scene + fmt::format("[run]\nuntil = {}\nprecision = \"mpfr\"\ndigits = {}\n", range.start.collapse,
                               std::max(particles.digits, 10U));
  }
  return "title = \"words of collapse\"\n[law]\ntype = \"inelastic\"\nrestitution = 0.05\n[initial]\n"
         "type = \"list\"\nx = [0, 1]\nv = [0, 0]\n[run]\nuntil = 1\n";
}

}  // namespace

std::string word_text(const WordParticles& particles, const WordReport& report) {
  std::string text = fmt::format("{}: {}\n", report.word, particles.text());
  if (particles.left_wall && particles.right_wall) return text + two_walls;
  if (report.in_order != report.word) text += fmt::format("  in order of time  {}\n", report.in_order);
  if (report.mirrored) text += "  symmetry          the second half is the mirror image of the first\n";
  if (!report.degenerate.empty()) text += fmt::format("  degenerate        {}\n", report.degenerate);
  if (report.ranges.empty())
    return text + fmt::format("  exists            at none of {} restitutions between 0 and 1 (seen, not proved)\n",
                              word_points);
  for (const WordRange& range : report.ranges) {
    text += fmt::format("  exists            for r from {} to {}\n", range.low.at, range.high.at);
    text += fmt::format("  existence         {}\n", proof_text(range));
    for (const auto& [name, end] : {std::pair("lower", &range.low), std::pair("upper", &range.high)})
      text += fmt::format("  {} end         {} ({})\n", name, end->reason, end->proved ? "proved" : "not proved");
    text += fmt::format("  at r = {}\n", range.at);
    text += fmt::format("    a period        multiplies speeds by {:.10g}, gaps by {:.10g}, times by {:.10g}\n",
                        range.lambda, range.gamma, range.gamma / range.lambda);
    text += fmt::format("    stability       {}: a period multiplies a perturbation by {:.6g}\n", range.stable,
                        range.factor);
    for (const auto& [from, to] : range.stable_ranges)
      text += fmt::format("    stable          for r from {:.10g} to {:.10g} (seen, not proved)\n", from, to);
    for (std::size_t i = 0; i < range.start.gaps.size(); ++i)
      text += fmt::format("    gap {}           {}, closing speed {}\n", static_cast<char>('a' + i),
                          range.start.gaps[i], range.start.speeds[i]);
    text += fmt::format("    collapse        at t = {}\n", range.start.collapse);
  }
  text += fmt::format("  not proved: that the word exists for no other r, in a range narrower than {:.1g} or outside\n",
                      1.0 / (word_points + 1));
  return text;
}

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
  Result result;
  result.attributes = provenance(parse_scene(scene_of(particles, reports), "words.toml"),
                                 fmt::format("mpfr, {} digits", 4 * particles.digits), "words of collapse");
  result.attributes.emplace_back("kind", std::string("words"));
  std::vector<std::string> word;
  std::vector<WordRange> ranges;
  for (const WordReport& report : reports) {
    word.insert(word.end(), report.ranges.size(), report.word);
    ranges.insert(ranges.end(), report.ranges.begin(), report.ranges.end());
  }
  const auto of_range = [&](const char* name, const std::string& description, auto value) {
    return Column{name, "1", description, numbers_of(ranges, value)};
  };
  using Range = const WordRange&;
  using Stable = std::pair<double, double>;
  const auto first_stable = [](double Stable::*end) {
    return [end](Range range) { return range.stable_ranges.empty() ? std::nan("") : range.stable_ranges[0].*end; };
  };
  const std::string end = "; proved to be within 1e-" + std::to_string(particles.digits) + " where ";
  result.groups.push_back(
      {"words",
       {{"particles", std::uint64_t{particles.particles}},
        {"system", particles.text()},
        {"tried", std::uint64_t{tried}},
        {"command", command},
        {"digits", std::uint64_t{particles.digits}}},
       {{"word", "1", "letters are gaps from the left", std::move(word)},
        of_range("low", "lower end of the restitutions for which the self-similar state exists",
                 [](Range range) { return range.low.value; }),
        of_range("high", "upper end", [](Range range) { return range.high.value; }),
        of_range("low_digits", "lower end, decimals cut off" + end + "low_proved is 1",
                 [](Range range) { return range.low.at; }),
        of_range("high_digits", "upper end, decimals cut off" + end + "high_proved is 1",
                 [](Range range) { return range.high.at; }),
        of_range("proved", "1: existence is proved up to both ends, and that they are ends", &WordRange::proved),
        of_range("low_proved", "1: it is proved that the state ends there",
                 [](Range range) { return range.low.proved; }),
        of_range("high_proved", "1: it is proved that the state ends there",
                 [](Range range) { return range.high.proved; }),
        of_range("proved_from", "existence is proved from this restitution on (rounded to a double)",
                 [](Range range) { return std::stod(range.proved_from); }),
        of_range("proved_to", "existence is proved up to this restitution (rounded to a double)",
                 [](Range range) { return std::stod(range.proved_to); }),
        of_range("low_reason", "what ends it below", [](Range range) { return range.low.reason; }),
        of_range("high_reason", "what ends it above", [](Range range) { return range.high.reason; }),
        of_range("at", "the restitution of what follows", [](Range range) { return std::stod(range.at); }),
        of_range("lambda", "by what a period multiplies closing speeds", &WordRange::lambda),
        of_range("gamma", "by what a period multiplies gaps", &WordRange::gamma),
        of_range("factor", "by what a period multiplies a small perturbation", &WordRange::factor),
        of_range("stable", "whether that is below 1", &WordRange::stable),
        of_range("stable_from", "the first range where the state is stable, as seen on a grid; NaN: none",
                 first_stable(&Stable::first)),
        of_range("stable_to", "end of that range", first_stable(&Stable::second)),
        of_range("gaps", "of the state half-way to the first collision; their sum is 1",
                 [](Range range) { return list_of(range.start.gaps); }),
        of_range("closing_speeds", "of that state; the largest one is 1",
                 [](Range range) { return list_of(range.start.speeds); })}});
  return result;
}

}  // namespace cradle::tools
