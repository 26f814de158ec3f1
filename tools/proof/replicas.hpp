// An ensemble of proved runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cradle/core/ensemble/ensemble.hpp"
#include "cradle/tools/proof/certify.hpp"

namespace cradle::tools {

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
