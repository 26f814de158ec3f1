// What an engine reports of a collapse, of what it could not resolve, and of a guard that found it at fault.
#pragma once

#include <cstdint>

#include "cradle/core/initial/particles.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/tools/engines/number.hpp"

namespace cradle::tools {

struct ReportedCollapse {
  Number last_collision, interval, gap;
  ParticleIndex particle = -1;
  bool settled = false;
  Number time, uncertainty, ratio, ratio_uncertainty;  // where it is
};

struct ReportedIncident {
  Number time;
  double gap = 0;
  ParticleIndex particle = -1;
};
struct ReportedAccount {
  std::uint64_t simultaneous = 0, order_lost = 0, unresolved = 0;
  ReportedIncident first_order_lost, first_unresolved;
  bool uncertain = false, uncertain_end = false;
  ReportedIncident first_uncertain;  // of both
};

struct ReportedGuard {
  Guard guard = Guard::order;
  double found = 0, bound = 0;
  ParticleIndex particle = -1;
  Number time;
};

}  // namespace cradle::tools
