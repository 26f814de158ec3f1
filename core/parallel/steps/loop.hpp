#pragma once
// The loop over steps: how long they are, and what is done where one has failed.

#include "cradle/core/parallel/steps/steps.hpp"

namespace cradle {

// Makes all collisions up to `end`. Returns in how many passes, or -1: some were made in the wrong order, or one of
// them is for the event loop.
using Step = int (*)(StepLine& line, const StepTask& task, StepScalars& scalars, double end, StepResult& result);

bool run_steps(Step step, StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace,
               StepResult& result);

}  // namespace cradle
