// The value of a key at which the outcome of a run changes: by bisection on decimals (bracket.cpp), with what is proved
// of the two runs beside it. Finished runs are kept in FILE.part, or in FILE itself, and are not repeated.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

/// What of a run is compared.
enum class Compare { collapse, gap, collisions, merges, pair };

struct CompareRow {
  Compare type;
  std::string_view name, text;
};
inline constexpr std::array<CompareRow, 5> compared{{
    {Compare::collapse, "collapse", "whether the run ends at an inelastic collapse that is proved"},
    {Compare::gap, "gap", "whether a gap falls below run.stop_gap, as in every collapse"},
    {Compare::collisions, "collisions", "number of collisions"},
    {Compare::merges, "merges", "number of merges"},
    {Compare::pair, "pair", "whether the two heavy clusters pass or stick"},
}};
static_assert(rows_in_order(compared));

inline constexpr std::string_view no_collapse = "no collapse";

/// What `cradle threshold` asks: a scene, a key of it that varies, and what is compared (threshold_problem.cpp).
class ThresholdProblem {
 public:
  /// `vary` is KEY=LOW:HIGH or KEY[I]=LOW:HIGH; `compare` a name of the table, empty: what suits the scene. Throws
  /// Error.
  ThresholdProblem(std::string scene, std::vector<std::string> overrides, const std::string& vary,
                   const std::string& compare, unsigned digits);

  const std::string& key() const { return key_; }  // with its index
  const Decimal& low() const { return low_; }
  const Decimal& high() const { return high_; }
  /// The scene at the lowest value.
  const Scene& at_low() const { return at_low_; }
  bool whole_numbers() const { return whole_; }
  unsigned digits() const { return digits_; }
  const CompareRow& what() const { return compared.at(static_cast<std::size_t>(compare_)); }

  /// The scene with this value. `wide`: in a type of more digits and a larger range than any number needs here; nothing
  /// if there is none beyond the scene's own.
  std::optional<Scene> scene_at(const Decimal& value, bool wide) const;
  /// Whether the scene's own type distinguishes the values.
  bool wide_from_the_start() const { return wide_; }
  /// The outcome as text; nothing if the run has none.
  std::optional<std::string> outcome(const RunOutcome& run) const;
  /// Differs between questions, and between numbers of digits that need runs in other types.
  std::uint64_t identity() const;
  /// What follows `cradle` to ask it again.
  std::string command(const std::string& scene_file) const;

 private:
  std::string assignment(const Decimal& value) const;
  void choose_key(const Scene& given);
  void choose_outcome(const std::string& compare);
  std::uint64_t wide_digits() const { return std::min(std::max(digits_ + 20, 50U), 1000U); }

  std::string scene_, key_, vary_;
  std::vector<std::string> overrides_;
  Scene at_low_;
  Decimal low_, high_;
  unsigned digits_;
  bool whole_ = false, wide_ = false;
  Compare compare_ = Compare::collisions;
  std::vector<std::string> items_;  // of a list; empty for a single number
  std::size_t item_ = 0;
};

/// Two decimals between which an outcome changes, and the next one to try: first whole multiples of a coarse power of
/// ten, then of finer ones, each by bisection. So values are as short as can be, and a search to more digits begins
/// with the values of a search to fewer. All arithmetic is on the decimals, exactly.
class Bracket {
 public:
  /// low < high, of which `digits` significant ones are wanted, counted from the first of the larger end; `whole`: only
  /// whole numbers. Throws Error for numbers of thousands of digits.
  Bracket(Decimal low, Decimal high, unsigned digits, bool whole);

  const Decimal& low() const { return low_; }
  const Decimal& high() const { return high_; }

  /// The value to try; none if the ends are neighbours.
  const std::optional<Decimal>& next() const { return next_; }
  /// The outcome at next() is that of the low end, or is not.
  void narrow(bool as_at_low);

  /// About how many values are left.
  unsigned values_left() const;

 private:
  void find_next();

  Decimal low_, high_;
  long unit_ = 0, last_ = 0;  // powers of ten: of the values tried now, and of the finest ones
  std::optional<Decimal> next_;
};

struct ExactCollapse {
  bool collapse = false;         // before the end of the run
  std::uint64_t collisions = 0;  // made until that was decided
};
/// Whether three particles collapse, decided in rational numbers from the scene's decimals: collision by collision
/// until the condition of the theorem in core/engine/README.md holds or fails. Nothing is rounded, so there is one
/// answer however near to a threshold; a run would need more collisions the nearer it is. Nothing for other scenes, and
/// where it stays open: two collisions at one time, a time of collapse that is just the end of the run, or no decision
/// within some sixty collisions.
std::optional<ExactCollapse> exact_collapse(const Scene& scene);

/// One run, or one decision without a run.
struct RunAt {
  std::string value, outcome;
  std::uint64_t collisions = 0, merges = 0;
  std::string how;  // "double", "mpfr, 50 digits" or "closed form"

  static auto state(auto& self) { return fields(self.value, self.outcome, self.collisions, self.merges, self.how); }
};

/// What is known of the outcome at one of the last two values.
struct ThresholdEnd {
  RunAt run;
  bool proved = false;
  std::string how;  // in words
};

struct Threshold {
  std::vector<RunAt> runs;  // in the order in which the bisection asks for them
  ThresholdEnd low, high;
  bool proved() const { return low.proved && high.proved; }
};

struct ThresholdOptions {
  Interrupt& interrupt;
  Progress::Show progress = Progress::Show::on_terminal;
  unsigned threads = 0;
  bool prove = true;
  Force force = Force::no;
};

/// Continues what `file` and its journal hold of this question. Throws Error: Exit::bad_input if the outcome is the
/// same at both ends, Exit::lost if a run has no outcome or a proof contradicts one, and when it is interrupted.
Threshold find_threshold(const ThresholdProblem& question, const std::string& file, const ThresholdOptions& options);

std::string threshold_text(const ThresholdProblem& question, const Threshold& found);
/// `command` is what follows `cradle` to make it.
Result threshold_result(const ThresholdProblem& question, const Threshold& found, const std::string& command);

}  // namespace cradle::tools
