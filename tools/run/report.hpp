// What a run prints at its end: the collapse that stopped it, and what it could not resolve.
#pragma once

#include <cstdint>
#include <string>

#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/tools/record/recorded.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/ends.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct ReportedCollapse {
  Number last_collision, interval, gap;
  ParticleIndex particle = -1;
  bool settled = false;
  Number time, uncertainty, ratio, ratio_uncertainty;  // where it is
};
template <Real T> ReportedCollapse reported(const CollapseReport<T>& r) {
  return {number_of(r.last_collision),
          number_of(r.interval),
          number_of(r.gap),
          r.particle,
          r.settled,
          number_of(T(r.time.value())),
          number_of(r.uncertainty),
          number_of(r.ratio),
          number_of(r.ratio_uncertainty)};
}
/// The text for standard output; times have all digits that are known.
/// `at_wall`: the wall on which it was, if it can hold particles.
std::string collapse_report(const ReportedCollapse& collapse, RunEnd end, std::uint64_t collisions,
                            const std::string& at_wall);
Group collapse_table(const ReportedCollapse& collapse);

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
template <Real T> ReportedAccount reported(const Account<T>& account) {
  const auto incident = [](const Incident<T>& i) {
    return ReportedIncident{number_of(i.time), to_double(i.gap), i.particle};
  };
  return {account.simultaneous,
          account.order_lost,
          account.unresolved,
          incident(account.first_order_lost),
          incident(account.first_unresolved),
          account.uncertain > 0,
          false,
          incident(account.first_uncertain)};
}
struct ReportedGuard {
  Guard guard = Guard::order;
  double found = 0, bound = 0;
  ParticleIndex particle = -1;
  Number time;
};
template <Real T> ReportedGuard reported(const GuardReport<T>& r, const T& time) {
  return {r.guard, to_double(r.found), to_double(r.bound), r.particle, number_of(time)};
}
/// The message of a guard that stops a run. What positions may not have resolved is not the machine's fault.
std::string guard_message(const ReportedGuard& guard, const ReportedAccount& account, const Run& run);

/// The text for standard error; empty if everything was resolved.
std::string account_warning(const ReportedAccount& account, const Scene& scene);
/// The warning when time or a gap cannot get smaller.
std::string exhausted_warning(const std::string& time, std::uint64_t collisions, const Scene& scene);

}  // namespace cradle::tools
