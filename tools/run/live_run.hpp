// A run that its caller holds: it advances when it is asked to, its state can be read between, and at its end it has
// the result that `cradle run` writes. The Python module binds it (tools/python/module); its files are in tools/live.
//
// Collisions, rows and bytes are those of `cradle run`, since the calls of `advance` do not matter to an engine. One
// scene is an exception: a sticky gas whose scene observes no collision is computed there directly at each output time.
// Here its collisions are made, which differ by rounding, and the file is computed as `cradle run` does.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cradle/core/base/state_stream.hpp"
#include "cradle/tools/run/run.hpp"

namespace cradle::tools {

struct LiveCollision {
  ParticleIndex left, right;  // by their numbers at the start
  double time, interval, closing_speed;
};

struct LiveOptions {
  unsigned threads = 0;        // 0: all processors
  std::function<void()> poll;  // called some times a second during a run; what it throws leaves `advance`
  std::function<double(double)> restitution;  // of the closing speed, instead of the scene's law; precision double only
  std::function<void(const Scene&)> begins;   // called before any number of the scene is made
};

/// After an exception from a function of the caller, the run is at its last collision and can continue. Callers with
/// several runs see to it that MPFR has the digits of the one that they call (set_digits).
class LiveRun {
 public:
  enum class Column { x, v, m, gap, closing_speed };  // of the particles, as in snapshots

  LiveRun() = default;
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  virtual ~LiveRun() = default;

  virtual const Scene& scene() const = 0;
  /// Throws Error for a time in the past or after the end, and if the run is over.
  virtual void advance(const Decimal& until) = 0;
  /// Makes the next `n` collisions, or those up to `until` if these are fewer: then the run is at that time. Returns
  /// the number of those that are left.
  virtual std::uint64_t step(std::uint64_t n, const Decimal& until) = 0;
  /// Ends the run at its last collision: what it has recorded can then be written. Throws Error if it is over.
  virtual void stop() = 0;
  /// Called before every collision from now on; empty: not any more.
  virtual void observe(std::function<void(const LiveCollision&)> observer) = 0;

  /// Null while the run is in progress.
  virtual const RunOutcome* over() const = 0;
  virtual const Counts& counts() const = 0;
  /// The decimals of these have all digits of the run's precision.
  virtual double time() const = 0;
  virtual std::string time_text() const = 0;
  virtual double energy() const = 0;  // kinetic, of all particles of the scene
  virtual std::string energy_text() const = 0;
  virtual std::vector<double> column(Column which) = 0;
  virtual std::vector<std::string> column_text(Column which) = 0;
  virtual const std::vector<ParticleIndex>& index() = 0;

  /// Saves all from which the run can continue. Throws Error, also if the run is over.
  virtual void save(StateSink& to) = 0;
  /// Throws Error unless the run is over and is that of its scene.
  virtual void require_result() const = 0;
  /// The result of a run that is over, as `cradle run` writes it. Throws Error as above.
  virtual Result result() = 0;
};

/// A run from the beginning, or from what another one has saved. Throws Error for scenes that cannot be run, or not in
/// this way.
std::unique_ptr<LiveRun> live_run(const Scene& scene, const LiveOptions& options, StateSource* from = nullptr);

}  // namespace cradle::tools
