// One run of a scene: initial state, engine, observers, result.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/run/sink.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/support/errors.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

/// The particles of a snapshot, and the numbers of the outermost ones at the start. Decimals have all digits of the
/// run's precision.
struct SampledParticles {
  std::pair<ParticleIndex, ParticleIndex> range{0, -1};
  std::vector<ParticleIndex> index;
  std::vector<std::string> x, v, m;
};

struct RunSample {
  RunSample(const RunState& now, const Scene& scene, const Schedule& plan, long double epsilon_, bool at_collision_)
      : time(now.time), state(now.state()), epsilon(epsilon_),
        requested(plan.requested(scene, time.exact, at_collision_)), of_series(plan.series().hold(time.exact)),
        at_collision(at_collision_) {
    using enum RunState::Column;
    if (!at_collision && plan.snapshots().hold(time.exact))
      particles = {now.range(), now.index(), now.column_text(x), now.column_text(v), now.column_text(m)};
  }

  RunTime time;
  SampledState state;
  long double epsilon;                   // of the run's precision
  std::vector<RequestedTime> requested;  // all requested times that this precision cannot distinguish from `time`
  bool of_series;
  bool at_collision;           // the run ends here, with its last collision
  SampledParticles particles;  // of a snapshot, else empty
};

/// Gets every collision before it is made, and a sample of the run at every output time. If it throws, the run ends.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void collision(ParticleIndex left, ParticleIndex right, double time) = 0;
  virtual void sample(const RunSample& sample) = 0;
};

struct RunOptions {
  Progress::Show progress = Progress::Show::on_terminal;
  RunObserver* observer = nullptr;  // gets every collision and every sample
  Interrupt* interrupt = nullptr;   // says whether to stop; heeded once there is something to keep
  Workers workers = {};             // for a run that is cut into segments
  std::string announcement = {};    // for standard error, once it is known that the run can begin
  bool held = false;                // by a caller who may observe collisions, or ask for a number of them
  std::function<double(double)> restitution = {};  // of the closing speed, instead of the scene's law; in double only
};

struct RunOutcome {
  Result result;  // of a run into memory
  RunEnd end = RunEnd::reached;
  std::string report;                        // of a collapse, for standard output; else empty
  std::string warning;                       // what was not resolved, for standard error; else empty
  std::string collapse_time;                 // where the run stopped at a collapse
  std::optional<double> collapsed_at;        // the same, rounded
  std::uint64_t collisions = 0, merges = 0;  // at the end, like time and energy
  double time = 0, energy = 0;
  double energy_digits = 10;                            // digits of the energy that rounding leaves right, ...
  bool may_have_grown = false;                          // ... unless it has grown, which nothing has followed
  double seconds = 0;                                   // of computing
  std::vector<std::pair<std::string, double>> summary;  // numbers of the whole run, by name: columns of /replicas
};

/// Where a result is from, for its attributes: versions, the effective scene, its name and precision, how it ended.
std::vector<Attribute> provenance(const Scene& scene, const std::string& precision, std::string_view outcome);

/// The scene stored in a result. Throws Error (Exit::io) naming the file.
Scene scene_in(const std::vector<Attribute>& attributes, const std::string& file);

/// Throws Error, naming the key, for a scene that this build or its precision cannot run; sets the digits.
void check_built(const Scene& scene);

/// The scene without tables that are only written: it makes the same collisions, and its series is the same.
Scene without_tables(Scene scene);

/// Runs the scene in its precision, coordinates and law, into a sink. Throws Error for what this build cannot do.
RunOutcome run_scene(const Scene& scene, const RunOptions& options, Sink& sink);
/// The same into memory: the outcome has the result.
RunOutcome run_scene(const Scene& scene, const RunOptions& options);
/// The same of a scene with initial.type = "clusters" (clusters.cpp). Throws Error if collisions are requested (trust).
RunOutcome run_clusters(const Scene& scene, const RunOptions& options, Sink& sink);

/// A run of a scene that is held by its caller. It advances when the caller asks it to, its state can be read between
/// these calls, and it writes its tables to a `Sink` (sink.hpp). `cradle run`, ensembles, proofs, thresholds and Python
/// all hold one. Its collisions, rows and bytes are the same however it is advanced.
///
/// If a function of the caller (an observer, say) throws, the run stands at its last collision and can continue. MPFR
/// has one precision per process: a caller with several runs must call set_digits for a run before it uses that run.
class SceneRun {
 public:
  explicit SceneRun(const Scene& scene) : scene_(scene) {}
  SceneRun& operator=(SceneRun&&) = delete;
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
