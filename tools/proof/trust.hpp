// How far a scene's numbers can be trusted: the same run at rising precision, each compared with the highest.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// One precision (in one representation) against the reference.
struct Trusted {
  std::string precision;    // "double", "mpfr, 50 digits"
  std::string coordinates;  // "gaps", "absolute"
  double seconds = 0;
  std::string outcome;
  /// Sequence of collisions at every particle right up to this sample, for good; to_end: in every sample.
  double time = 0;
  std::uint64_t collisions = 0;
  bool to_end = false;
  /// Up to this sample that sequence is proved (certify), in a scene of which a proof exists; NaN: nowhere.
  double proved_time = none();
  bool proved_to_end = false;
  /// Counts (collisions, merges) right up to this time.
  double counts_time = 0;
  /// Energy and right front have six digits of the reference or more in all samples up to this time; NaN: in none.
  double six_digits_time = none();
  /// Per sample: decimal digits to which energy and right front agree with the reference, no more than the type has.
  std::vector<double> times, energy_digits, front_digits;
  double collapse_digits = -1;  // of the collapse time; -1: the run did not stop at a collapse
};

struct TrustOptions {
  std::vector<unsigned> digits;  // 16: double, 31: double-double, others: mpfr; empty: rising until two runs agree
  bool both = false;             // absolute coordinates too
  Progress::Show progress = Progress::Show::on_terminal;
  Interrupt* interrupt = nullptr;
  unsigned threads = 1;  // 0: as many as the machine has
};

/// The last entry is the reference itself. Throws Error for a scene that cannot be run.
std::vector<Trusted> trust(const Scene& scene, const TrustOptions& options);

/// A table for people, and one for files.
std::string trust_table(const Scene& scene, const std::vector<Trusted>& runs);
Result trust_result(const Scene& scene, const std::vector<Trusted>& runs);

}  // namespace cradle::tools
