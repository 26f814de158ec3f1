// Merges ensembles (or sweeps) of the same scene with different replicas into one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/ensemble_store.hpp"

namespace cradle::tools {

/// All replicas of all files. Throws Error: Exit::bad_input if the files have different scenes or share replicas;
/// Exit::io if a file cannot be read or is damaged.
std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files);

}  // namespace cradle::tools
