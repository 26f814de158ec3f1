// Words of collapse: for which restitutions particles can repeat a word of collisions for ever, as text, as a result
// file, as a scene. The mathematics and the proofs are in core/words; here they get decimals, digits and names.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/words/word.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/setup/word_start.hpp"

namespace cradle::tools {

inline constexpr std::size_t word_points = 1999;  // of the grid on which restitutions are inspected

/// 3 to 6 particles, masses "1,2.5,1" (empty: equal), walls "", "left", "right" or "both". Throws Error.
WordParticles word_particles(const std::string& count, const std::string& masses, const std::string& walls,
                             unsigned digits);

struct WordEnd {
  std::string at;  // decimal, `digits` digits after the point
  double value = 0;
  std::string reason;
  bool proved = false;  // that the state ends in between
};

/// A range of restitutions.
struct WordRange {
  WordEnd low, high;
  std::string proved_from, proved_to;  // existence is proved from here to there
  bool proved = false;                 // up to both ends
  // At one restitution: how a period changes speeds and gaps, how fast a perturbation grows in it.
  std::string at;
  double lambda = 0, gamma = 0, factor = 0;
  std::string stable;  // "stable, proved", "unstable, proved", "stable", "unstable"
  // Where it is stable: seen on a finer grid, not proved.
  std::vector<std::pair<double, double>> stable_ranges;
  WordStart start;
};

struct WordReport {
  std::string word, in_order;  // as given; in the order of times
  bool mirrored = false;       // its second half is the mirror image of the first
  std::vector<WordRange> ranges;
  std::string degenerate;  // where three particles meet, in words; empty: nowhere
};

/// Everything about a word; `at` is the restitution of its state, the middle of the range if not given. Throws Error.
WordReport report_word(const WordParticles& particles, const words::Word& word, const std::optional<Decimal>& at);

/// All words of up to so many letters that exist somewhere; `found` is called for each.
std::vector<WordReport> search_words(const WordParticles& particles, std::size_t longest,
                                     const std::function<void(const WordReport&)>& found, std::size_t& tried);

std::string word_text(const WordParticles& particles, const WordReport& report);
/// A line of a table.
std::string word_line(const WordReport& report);

/// `command` is what follows `cradle` to make the result.
Result words_result(const WordParticles& particles, const std::vector<WordReport>& reports, std::size_t tried,
                    const std::string& command);

}  // namespace cradle::tools
