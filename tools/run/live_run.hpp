// A run that its caller holds: it advances when it is asked to, its state can be read between, and at its end it writes
// the file that `cradle run` writes. The Python module binds it (tools/python/module).
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

#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/overwrite.hpp"

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

/// The kind of its checkpoints (JournalHeader::kind).
inline constexpr const char* live_kind = "simulation";

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

  /// Writes a file from which `load_live_run` continues. Throws Error, also if the run is over.
  virtual void save(const std::string& path) = 0;
  /// Writes the result of a run that is over. It replaces only what `cradle run` would replace. Throws Error.
  virtual void write(const std::string& path, Force force) = 0;
};

/// Throws Error for scenes that cannot be run, or not in this way.
std::unique_ptr<LiveRun> live_run(const Scene& scene, const LiveOptions& options);
std::unique_ptr<LiveRun> load_live_run(const std::string& path, const LiveOptions& options);

}  // namespace cradle::tools
