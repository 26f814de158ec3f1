#pragma once
// Replicas of which every fifth fails: its initial state throws, since the particles of its list are out of order.

#include "cradle/tools/ensemble/ensemble.hpp"

namespace cradle::tests {

inline tools::RunOutcome run_or_fail(const tools::Scene& replica, const tools::RunOptions& how) {
  tools::Scene changed = replica;
  if (replica.initial.replica % 5 == 2) {
    changed.initial = {};
    changed.initial.type = tools::InitialType::list;
    changed.initial.x = {"1", "0"};
    changed.initial.v = {"0", "0"};
  }
  return tools::run_scene(changed, how);
}

}  // namespace cradle::tests
