// A run and the proof that it is right: the run proposes collisions in its own precision, the checker of core/certify
// proves them in balls of rising digits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/proof/certificate.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

/// One try: how long it took, and where it ended.
struct Attempt {
  std::string precision;  // of the run
  std::string digits;     // of the balls
  double seconds = 0;
  std::string doubt;  // empty: none
};

/// 31 (double-double) and, where this build has MPFR, 50, 100, 200, 400, 800.
std::vector<unsigned> rising_digits();

/// Makes what checks a run, in balls of so many digits.
using MakeCertifier = std::function<std::unique_ptr<Certifier>(const Scene&, unsigned digits)>;

struct CertifyOptions {
  std::vector<unsigned> digits = rising_digits();  // of the balls, rising
  Progress::Show progress = Progress::Show::on_terminal;
  Interrupt* interrupt = nullptr;
  MakeCertifier make = certifier;
  unsigned threads = 1;  // 0: as many as the machine has
};

struct Certified {
  Scene scene;         // in the precision of the last try
  RunOutcome outcome;  // without a result where the proof ended before the run
  Certificate certificate;
  std::vector<Attempt> attempts;

  bool proved() const { return undecided().empty(); }
  /// Where it is undecided, in words; empty: nowhere, up to the end of the run.
  std::string undecided() const;
  /// What the run says of its samples and its end that no proof covers; empty: nothing.
  std::string not_proved() const;
};

/// The first reason why a scene cannot be proved; nothing if it can.
std::optional<Error> not_provable(const Scene& scene);
/// Throws Error for a scene that cannot be proved.
void check_certifiable(const Scene& scene);

/// Throws Error for a scene that cannot be run or proved, where it is interrupted, and where the run in no precision
/// has the numbers that are proved of it (Exit::lost), which no scene can bring about.
Certified certify(const Scene& scene, const CertifyOptions& options);

/// A report that can be quoted, and how long each attempt took.
std::string certificate_text(const Certified& run);
std::string attempts_text(const Certified& run);
/// The run's result with the certificate in it; where the proof ended, what is proved up to there.
Result certified_result(Certified run);

// ---- an ensemble of proved runs (replicas.cpp)

struct CertifiedReplica {
  std::uint64_t index = 0;
  bool proved = false;
  unsigned digits = 0;
  std::uint64_t collisions = 0;
  Enclosure<double> energy{0, 0};  // at the end
  std::string doubt;               // where it is not proved
  // Until the statistics have them: in the middle of their bounds at the times of the series, NaN after a collapse.
  std::vector<double> energies;
};

struct CertifiedReplicas {
  Scene scene;
  std::vector<CertifiedReplica> replicas;  // by index
  std::vector<double> times;
  Moments energy;  // at these times, of those that are proved
};

/// All of them side by side in the first number of digits; those that are undecided then one by one in more, since
/// MPFR has one precision per process. `threads` 0: as many as the machine has. Throws Error for a scene that cannot be
/// run, and where it is interrupted.
CertifiedReplicas certify_replicas(const Scene& scene, std::uint64_t count, unsigned threads,
                                   const CertifyOptions& options);

std::string replicas_text(const CertifiedReplicas& run);
Result replicas_result(const CertifiedReplicas& run);

}  // namespace cradle::tools
