// What a file of ensembles contains, and whether two files contain the same: same scenes, same version of the program,
// same bins, same listed particles.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/state.hpp"

namespace cradle::tools {

using EnsembleStates = std::vector<std::unique_ptr<EnsembleState>>;

/// What a file of ensembles contains: one ensemble, or one for each point of a sweep.
struct Study {
  struct Point {
    std::string group;  // in the file: "points/0003"; "": the file itself
    Scene scene;
  };

  std::string kind = "ensemble";
  Scene scene;  // the file's; for a sweep the scene that is varied
  std::vector<Point> points;
  std::vector<SpreadRequest> spreads = {};

  /// Equal for the same ensembles by the same version of the program.
  std::uint64_t identity() const;
};

/// A warning for standard error if all replicas of a point are the same run, since nothing in its scene is random:
/// which point, and why. Else empty.
std::string same_replicas_warning(const Study& study, std::uint64_t replicas);

/// The number of replicas of all ensembles.
std::uint64_t replicas_in(const EnsembleStates& states);

/// The study of one ensemble.
Study ensemble_of(const Scene& scene, std::vector<SpreadRequest> spreads = {});

}  // namespace cradle::tools
