// `SceneRun` is a run of a scene that is held by its caller. It advances when the caller asks it to, its state can be
// read between these calls, and it writes its tables to a `Sink` (sink.hpp). `cradle run`, ensembles, proofs,
// thresholds and Python all hold a `SceneRun`. Its collisions, rows and bytes are the same however it is advanced.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "cradle/core/base/state_stream.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

/// If a function of the caller (an observer, say) throws, the run stands at its last collision and can continue. MPFR
/// has one precision per process: a caller with several runs must call set_digits for a run before it uses that run.
class SceneRun {
 public:
  explicit SceneRun(const Scene& scene) : scene_(scene) {}
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;
  virtual ~SceneRun() = default;

  const Scene& scene() const { return scene_; }
  /// Begins a new run, of the replica whose number the scene now has, in the memory of this one; only for sinks that do
  /// not continue runs. After an exception of any function make another run instead.
  virtual void begin_again() = 0;
  /// Throws Error for a time in the past or after the end, and if the run is over.
  virtual void advance(const Decimal& until) = 0;
  /// Makes the next `n` collisions. If there are fewer up to `until`, makes these, and the run is then at that time.
  /// Returns how many of the `n` were not made. As `observe`, it is only for runs for which RunOptions::held is true.
  virtual std::uint64_t step(std::uint64_t n, const Decimal& until) = 0;
  /// Ends the run at its last collision: what it has recorded can then be written. Throws Error if it is over.
  virtual void stop() = 0;
  /// From now on `observer` is called before every collision; an empty one ends that.
  virtual void observe(CollisionObserver observer) = 0;

  /// Null while the run is in progress.
  const RunOutcome* over() const { return over_ ? &*over_ : nullptr; }
  virtual const Counts& counts() const = 0;
  /// Its text has all digits of the run's precision.
  virtual Number time() const = 0;
  /// The state at this time.
  virtual const RunState& now() = 0;

  /// Gives the rows recorded so far to the sink.
  virtual void put_rows() = 0;
  /// Saves all that the run needs, besides the rows, to continue. Throws Error if it is over.
  virtual void save(StateSink& to) = 0;
  /// Continues from there, with the rows that were saved beside it. Throws Error for the state of another run.
  virtual void load(StateSource& from) = 0;

 protected:
  void require_in_progress() const;

  const Scene& scene_;
  std::optional<RunOutcome> over_;
};

/// A run from the beginning, or from what the sink continues. Scene and sink must outlive it. Throws Error if the scene
/// cannot be run, or not with RunOptions::restitution, and for the model of clusters, which has no particles.
std::unique_ptr<SceneRun> begin_run(const Scene& scene, const RunOptions& options, Sink& sink);

}  // namespace cradle::tools
