// An engine for code that is the same for all scalar types. All that must be computed in the type is behind this
// interface, which is implemented once per type (any_engine_in.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/observe/histograms.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/tools/engines/number.hpp"
#include "cradle/tools/engines/run_state.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

/// A collision before it is made.
struct ObservedCollision {
  struct Texts {
    std::string time, interval, closing_speed;
  };

  ParticleIndex left = -1, right = -1;  // by their numbers at the start
  double time = 0, interval = 0, closing_speed = 0;

  virtual double time_low() const = 0;  // what `time` misses
  virtual Texts texts() const = 0;      // with all digits

 protected:
  ~ObservedCollision() = default;
};
using CollisionObserver = std::function<void(const ObservedCollision&)>;

using ReportedCollapse = CollapseReport<Number, Number>;

/// The guards of all particles (core/observe/guards.hpp).
struct CheckedParticles {
  std::optional<ReportedGuard> broken;
  double gap_min, closure_gap, closure_speed;
  std::uint64_t merged;  // particles that are in others
};

struct EngineOptions {
  std::function<bool()> interrupt;
  std::function<void(double time, const Counts&)> progress;
  Workers workers;
  bool observed = false;                      // whether the collisions are needed one by one
  std::function<double(double)> restitution;  // of the closing speed, instead of the scene's law; in double only
};

class AnyEngine {
 public:
  AnyEngine& operator=(AnyEngine&&) = delete;
  virtual ~AnyEngine() = default;

  /// Begins again with another replica, whose number the scene now has.
  virtual void begin_again() = 0;
  /// `observer` may be empty.
  virtual Status advance(const Number& until, const CollisionObserver& observer) = 0;
  /// Makes the next `left` collisions, or those up to `until` if these are fewer, and subtracts them from `left`.
  virtual Status step(std::uint64_t& left, const Number& until, const CollisionObserver& observer) = 0;

  virtual const Counts& counts() const = 0;
  virtual Number last_collision_time() const = 0;
  virtual ParticleIndex particles() const = 0;
  virtual ParticleIndex collided_particles() const = 0;
  virtual Account<Number> account() const = 0;
  virtual ReportedCollapse collapse() const = 0;
  virtual long double epsilon() const = 0;  // of the type

  /// At a time that is not before the last collision; `at_collision`: right after that one.
  virtual std::unique_ptr<RunState> state_at(const RunTime& time, bool at_collision = false) = 0;

  /// Checks all particles at such a time.
  virtual CheckedParticles check(const Number& time) = 0;
  virtual bool collided_since_check() const = 0;

  /// Counts collisions from now on (core/observe/histograms.hpp).
  virtual void count_collisions(const Counting& counting, const OctaveBins& bins, bool flights) = 0;
  /// Free flights, pair flights, closing speeds, dissipative ones, collisions per particle.
  virtual std::array<std::vector<std::uint64_t>, 5> counted_collisions() = 0;
  /// Tags every k-th particle, for RunState::tagged; returns how many these are.
  virtual std::size_t tag(ParticleIndex every) = 0;

  virtual void save(StateSink& to) const = 0;
  virtual void load(StateSource& from) = 0;
  virtual std::string shape() const = 0;  // of what is saved
};

/// Throws Error if the scene cannot be run, or not with EngineOptions::restitution.
std::unique_ptr<AnyEngine> begin_engine(const Scene& scene, const EngineOptions& options);

/// Rounds a decimal once to the scalar type of a scene.
using Rounding = Number (*)(std::string_view decimal);
/// Throws Error for a scalar type that this build does not have.
Rounding rounding(const Scene& scene);

/// "double", "mpfr, 50 digits", ...
std::string precision_name(const Run& run);

/// Sets MPFR's number of digits, of which a process has one at a time, if the scene's numbers are of that type. Throws
/// Error for a type that this build does not have.
void set_digits(const Scene& scene);

}  // namespace cradle::tools
