// How a run ends: its outcome, with the warnings that its account gives rise to, and the attributes of its result.
#pragma once

#include <optional>
#include <vector>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

struct RunEnding {
  RunOutcome outcome;
  std::vector<Attribute> attributes;
  std::optional<Group> collapse;

  RunEnding(const Scene& scene, const AnyEngine& engine, const Moment& now, Status status);
};

}  // namespace cradle::tools
