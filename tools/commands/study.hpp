// What `ensemble` and `sweep` share: run a study, report how it ended, return the exit status.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"

namespace cradle::tools {

/// The most replicas, and the highest number of one: float64 counts exactly up to here.
inline constexpr std::uint64_t most_replicas = std::uint64_t{1} << 53;

struct StudyPlan {
  Study study;
  EnsembleOptions options;
  std::string output;
  std::string note = {};  // for the user
};

/// Runs the replicas of the plan that its output does not have yet. Under MPI every rank makes the plan; an error in it
/// is reported once.
Exit run_study_command(bool quiet, const std::function<StudyPlan()>& make_plan);

}  // namespace cradle::tools
