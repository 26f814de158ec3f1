// What a file of ensembles is about, and how to decide whether two files are about the same: same scenes, same version
// of the program, same bins, same listed particles.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cradle/tools/ensemble/state.hpp"

namespace cradle::tools {

using EnsembleStates = std::vector<std::unique_ptr<EnsembleState>>;

/// What a file of ensembles is about: one ensemble, or several, one for each point of a sweep.
struct Study {
  struct Point {
    std::string group;  // in the file: "points/0003"; "": the file itself
    Scene scene;
  };

  std::string kind = "ensemble";
  Scene scene;  // the file's; in a sweep what the points are varied from
  std::vector<Point> points;
  std::vector<SpreadRequest> spreads = {};
  std::vector<Attribute> attributes = {};                                 // of the file, beside the usual ones
  std::function<std::vector<Group>(const EnsembleStates&)> summary = {};  // written before the points

  /// The same number for the same ensembles by the same version of the program.
  std::uint64_t identity() const;
};

/// Where so many replicas of a point are one and the same run, since nothing in its scene is random: which and why, for
/// standard error; else empty.
std::string same_replicas_warning(const Study& study, std::uint64_t replicas);

/// Replicas of all of them.
std::uint64_t replicas_in(const EnsembleStates& states);

/// The study of one ensemble.
Study ensemble_of(const Scene& scene, std::vector<SpreadRequest> spreads = {});
/// "ensemble" or "sweep". Throws Error (Exit::bad_input) for a file that holds neither.
std::string study_kind(const Result& result, const std::string& file);

/// The study of the one ensemble that a file holds, the scene as it stands there.
Study ensemble_in(const Result& result, const std::string& file);

/// The first key in which two scenes differ, with both values; empty if there is none.
std::string scene_difference(const Scene& found, const Scene& wanted);

}  // namespace cradle::tools
