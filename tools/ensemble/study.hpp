// What a file of ensembles contains, and whether two files contain the same: same scenes, same version of the program,
// same bins, same listed particles. It is one ensemble, or a parameter sweep: variations of a scene, one ensemble each,
// with a table of their results. The points of a sweep are keys and values, from the command line or from the table
// [sweep] of a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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

/// The study of one ensemble.
Study ensemble_of(const Scene& scene, std::vector<SpreadRequest> spreads = {});

/// What the journal of this result would begin with. `otherwise`: what to do where it holds no ensembles.
JournalHeader header_in(const Result& result, const std::string& file, const char* otherwise);
/// The study of a journal of replicas, or of a result. Throws Error (Exit::io) naming it, and `of_other_scenes` if the
/// identity is not that of its scenes.
Study study_in(const JournalHeader& header, const std::string& path, const Error& of_other_scenes);

/// A warning for standard error if all replicas of a point are the same run, since nothing in its scene is random:
/// which point, and why. Else empty.
std::string same_replicas_warning(const Study& study, std::uint64_t replicas);

/// The number of replicas of all ensembles.
std::uint64_t replicas_in(const EnsembleStates& states);

// ---- sweeps (sweep.cpp)

/// The settings of a point, as `--set` takes them: "law.loss=0.1".
using SweepPoint = std::vector<std::string>;

/// The points of a sweep, in order. First those given one by one; then all combinations of the varied keys, the last
/// key varying fastest, or (cuts) one key varied at a time. A key is varied by KEY=FROM:TO:COUNT (even steps, both ends
/// included), KEY=FROM:TO:COUNT:log (even in the logarithm), or KEY=VALUE,VALUE,... Throws Error naming what cannot be
/// read. Throws Error for more points than `most`, before allocating them.
std::vector<SweepPoint> sweep_points(const Sweep& sweep, double most = 1e6);

/// The number, if the text is a finite number and nothing else.
std::optional<double> to_number(const std::string& text);

/// The study of a scene at these points; a point is set after `overrides`. Throws Error, naming the point, if its scene
/// is not valid.
///
/// In the file `/points/0000` and so on are the ensembles.
Study sweep_of(const std::string& scene, const std::vector<std::string>& overrides, const Sweep& sweep);

/// `/sweep`, a row per point: a column for every key that takes numbers (named as the key; NaN at points that do not
/// set it), `label`s as attributes, how many replicas ended, and for every number of the replicas (collisions, energy,
/// ...) its mean and the standard error of the mean (`_error`).
Group sweep_summary(const Sweep& sweep, const EnsembleStates& states);

}  // namespace cradle::tools
