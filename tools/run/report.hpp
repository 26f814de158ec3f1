// How a run ends, and what it says then: its outcome, with the collapse that stopped it and the warnings that its
// account gives rise to, and the attributes of its result.
#pragma once

#include <string>
#include <vector>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// How a run ended, without texts.
RunOutcome outcome_of(const Scene& scene, const AnyEngine& engine, const RunState& now, Status status);

struct RunEnding {
  RunOutcome outcome;
  std::vector<Attribute> attributes;
  std::vector<Group> collapse;  // tables

  RunEnding(const Scene& scene, const AnyEngine& engine, const RunState& now, Status status);
};

/// The message of a guard that stops a run. What positions may not have resolved is not the machine's fault.
std::string guard_message(const ReportedGuard& guard, const Account<Number>& account, const Run& run);

}  // namespace cradle::tools
