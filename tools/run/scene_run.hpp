// A run of a scene that its caller holds: it advances when it is asked to, its state can be read between, and its
// tables go to a sink. `cradle run`, ensembles, proofs, thresholds and Python all hold this. Collisions, rows and bytes
// do not depend on how it is advanced.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cradle/core/base/state_stream.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// After an exception from a function of the caller, the run is at its last collision and can continue. Callers with
/// several runs see to it that MPFR has the digits of the one that they call (set_digits).
class SceneRun {
 public:
  using Column = Moment::Column;  // of the particles, as in snapshots

  explicit SceneRun(const Scene& scene) : scene_(scene) {}
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;
  virtual ~SceneRun() = default;

  const Scene& scene() const { return scene_; }
  /// Throws Error for a time in the past or after the end, and if the run is over.
  virtual void advance(const Decimal& until) = 0;
  /// Makes the next `n` collisions, or those up to `until` if these are fewer: then the run is at that time. Returns
  /// the number of those that are left. Like `observe`, of runs for which RunOptions::held is true.
  virtual std::uint64_t step(std::uint64_t n, const Decimal& until) = 0;
  /// Ends the run at its last collision: what it has recorded can then be written. Throws Error if it is over.
  virtual void stop() = 0;
  /// Called before every collision from now on; empty: not any more.
  virtual void observe(CollisionObserver observer) = 0;

  /// Null while the run is in progress.
  const RunOutcome* over() const { return over_ ? &*over_ : nullptr; }
  virtual const Counts& counts() const = 0;
  /// The texts of these have all digits of the run's precision.
  virtual Number time() const = 0;
  virtual Number energy() const = 0;  // kinetic, of all particles of the scene
  virtual std::vector<double> column(Column which) = 0;
  virtual std::vector<std::string> column_text(Column which) = 0;
  virtual const std::vector<ParticleIndex>& index() = 0;

  /// Gives the rows recorded so far to the sink.
  virtual void put_rows() = 0;
  /// Saves all else from which the run can continue. Throws Error if it is over.
  virtual void save(StateSink& to) = 0;
  /// Continues from there, with the rows that were saved beside it. Throws Error for the state of another run.
  virtual void load(StateSource& from) = 0;

 protected:
  void require_in_progress() const;

  const Scene& scene_;
  std::optional<RunOutcome> over_;
};

/// A run from the beginning, or from what the sink continues. Scene and sink must outlive it. Throws Error for scenes
/// that cannot be run, or not with a restitution that is a function, and for the model of clusters, which has no
/// particles.
std::unique_ptr<SceneRun> begin_run(const Scene& scene, const RunOptions& options, Sink& sink);

}  // namespace cradle::tools
