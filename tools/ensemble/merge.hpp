// Ensembles (or sweeps) of the same scene with different replicas, as one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cradle/tools/store/ensemble_store.hpp"

namespace cradle::tools {

/// The replicas of all files. Throws Error: Exit::bad_input for files of different scenes, or with replicas in common;
/// Exit::io for those that cannot be read or are damaged.
std::unique_ptr<EnsembleStore> merged(const std::vector<std::string>& files);

}  // namespace cradle::tools
