// What a proof of a run says: that every collision is that of the exact system, and within which bounds its numbers
// lie; or where it ends.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cradle/core/certify/checker.hpp"
#include "cradle/precision/ball_text.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// A number between two: decimals with all digits that are known, and doubles, both rounded outwards.
struct Enclosed {
  Enclosure<std::string> decimals{"-inf", "inf"};
  Enclosure<double> doubles{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  long double radius = std::numeric_limits<long double>::infinity();
};

/// Columns of such numbers: NAME_low and NAME_high, as doubles and as decimals; NaN where there is none.
struct Bounds {
  std::vector<double> low, high;
  std::vector<std::string> low_text, high_text;

  void add(const std::optional<Enclosed>& x);
  void put(Group& doubles, Group& exact, const std::string& name, const std::string& unit,
           const std::string& what) const;
};

/// The account of a wall since the start.
struct CertainWallSample {
  std::uint64_t collisions = 0;
  Enclosed given, lost;
};

/// What is certain at a time of the run.
struct CertainSample {
  double time = 0;        // as the run has it
  std::string time_text;  // the decimal that it stands for; everything else refers to this time
  bool of_series = false;
  std::uint64_t collisions = 0;
  Enclosed energy;
  std::optional<Enclosed> front_left, front_right;
  double widest = 0, least_gap = 0, widest_of_gap = 0;  // powers of ten, see CertainState
  std::array<std::optional<CertainWallSample>, 2> walls = {};
  bool over = false;  // no particles approach each other any more
};

/// Where a proof ends (Doubt), as text.
struct ReportedDoubt {
  Check check = Check::gap;
  bool refuted = false;
  ParticleIndex left = -1, right = -1;
  double time = 0;               // of the run
  std::uint64_t collisions = 0;  // proved before it
  std::string first, second;     // middles of the two quantities, and
  long double width = 0;         // the sum of their radii
  std::string quantity = {};     // agreement: of the run and of the proof
};
/// "at t = 5.25, after 12 collisions, particles 3 and 4: open whether the gap between them is positive: ...".
std::string doubt_text(const ReportedDoubt& doubt);

struct Certificate {
  std::string digits_text;  // "double-double", "mpfr, 100 digits"
  unsigned digits = 0;
  std::optional<ReportedDoubt> doubt;  // none: proved to the last sample
  std::uint64_t collisions = 0, in_doubles = 0;
  std::vector<CertainSample> samples;
  std::vector<std::string> open_samples;  // times at which a collision falls, if it does so before or after them
  std::vector<Group> snapshots;           // certificate/snapshots/NNNN and exact/snapshots/NNNN
};

/// Thrown where a proof ends before its run: there is no use in continuing.
struct ProofEnds {};

/// Checks a run while it is in progress.
class Certifier : public RunObserver {
 public:
  /// From now on collisions are checked on a thread of their own, while the run makes the next ones.
  virtual void check_beside() = 0;
  /// Checks all collisions that are not checked yet, as a sample does. Throws ProofEnds.
  virtual void check_all() = 0;
  virtual Certificate certificate() const = 0;
  /// The first number of the run's tables that is not what is proved of it, within the run's rounding. Without one the
  /// tables have the proved numbers then.
  virtual std::optional<ReportedDoubt> disagreement(Result& result) const = 0;

  bool sample_is_open = false;  // on which side of the last sample a collision falls
};

/// In balls of so many digits: 31, or what MPFR is set to. Throws Error for what this build has not.
std::unique_ptr<Certifier> certifier(const Scene& scene, unsigned digits);

}  // namespace cradle::tools
