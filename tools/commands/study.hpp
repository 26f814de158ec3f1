// What `ensemble` and `sweep` have in common: runs a study, reports how it went, gives the exit status.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"

namespace cradle::tools {

/// How many there may be, and the highest number of one: what float64 counts exactly.
inline constexpr std::uint64_t most_replicas = std::uint64_t{1} << 53;

struct StudyPlan {
  Study study;
  ReplicaRange replicas;  // of every point
  std::string output;
};

/// Runs what the plan's output does not have yet. Under MPI every rank makes the plan; what is wrong with it is
/// reported once.
Exit run_study_command(const RunningOptions& options, const std::function<StudyPlan()>& make_plan);

}  // namespace cradle::tools
