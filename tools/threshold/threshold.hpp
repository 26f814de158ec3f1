// The value of a key at which the outcome of a run changes: by bisection on decimals (bracket.hpp), with what is proved
// of the two runs beside it. Finished runs are kept in FILE.part, or in FILE itself, and are not repeated.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"
#include "cradle/tools/threshold/bracket.hpp"
#include "cradle/tools/threshold/question.hpp"

namespace cradle::tools {

/// One run, or one decision without a run.
struct RunAt {
  std::string value, outcome;
  std::uint64_t collisions = 0, merges = 0;
  std::string how;  // "double", "mpfr, 50 digits" or "closed form"

  static auto state(auto& self) { return std::tie(self.value, self.outcome, self.collisions, self.merges, self.how); }
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
Threshold find_threshold(const Question& question, const std::string& file, const ThresholdOptions& options);

std::string threshold_text(const Question& question, const Threshold& found);
/// `command` is what follows `cradle` to make it.
Result threshold_result(const Question& question, const Threshold& found, const std::string& command);

}  // namespace cradle::tools
