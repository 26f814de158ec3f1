// What `run` and `resume` share: compute, report how the run ended, return the exit status.
#pragma once

#include <string>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tools {

/// Runs the scene of the files into `output`, which the caller has claimed.
Exit run_command(RunFiles& files, const std::string& output, const RunningOptions& options, Interrupt& interrupt);

}  // namespace cradle::tools
