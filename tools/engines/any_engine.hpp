// An engine, the state of its run at one time and their numbers, for code that is the same for all scalar types. All
// that must be computed in the type is behind these interfaces, which are implemented once per type (any_engine_in.hpp,
// run_state_in.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/observe/averages.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/observe/histograms.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/structure.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/core/parallel/workers.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/precision/text.hpp"
#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

// ---- numbers: the nearest double, and what the type holds beyond that

inline double none() { return std::numeric_limits<double>::quiet_NaN(); }

/// A number of a type wider than double, or a decimal.
struct ExactNumber {
  virtual ~ExactNumber() = default;
  virtual std::string text() const = 0;  // all digits
  /// The other number has the same type.
  virtual bool is_less(const ExactNumber& other) const = 0;
};

struct Number {
  double value = 0;                                    // NaN has one form
  std::shared_ptr<const ExactNumber> exact = nullptr;  // null if that is all

  std::string text() const { return exact ? exact->text() : to_text(value); }
  /// Of numbers of one engine.
  friend bool operator<(const Number& a, const Number& b) {
    return a.value != b.value ? a.value < b.value : a.exact && a.exact->is_less(*b.exact);
  }
};

struct DecimalNumber final : ExactNumber {
  explicit DecimalNumber(std::string decimal) : digits(std::move(decimal)) {}
  std::string text() const override { return digits; }
  bool is_less(const ExactNumber& other) const override { return Decimal(digits) < Decimal(other.text()); }
  const std::string digits;
};

/// A time of a run: in the type of its engine, and what it means, which for a time that the scene gives is a decimal,
/// rounded once to a double.
struct RunTime {
  Number exact, meant;

  RunTime(const Number& time) : exact(time), meant(time) {}
  RunTime(const Number& time, double rounded, std::string meant_text)
      : exact(time), meant{rounded, time.exact ? std::make_shared<DecimalNumber>(std::move(meant_text)) : nullptr} {}
  /// All digits of the type, or the decimal if that is shorter and another number.
  RunTime(const Number& time, std::string_view decimal) : RunTime(time) {
    if (!time.exact) return;
    const std::string text = time.text();
    const bool shorter = decimal.size() < text.size() && Decimal(decimal) != Decimal(text);
    *this = RunTime(time, from_text<double>(decimal), shorter ? std::string(decimal) : text);
  }
};

// ---- the state of a run

using Stopped = std::function<bool()>;

struct SampledState {  // core/observe/sample.hpp
  struct Wall {
    std::uint64_t collisions = 0;
    Number given, momentum, dissipated;
  };
  Number energy, energy_lost;
  Counts counts;
  ParticleIndex particles = 0;
  std::optional<Number> front_left, front_right;
  std::array<Wall, 2> walls;
};

struct SampledCloud {  // core/observe/scenario.hpp
  struct Heaviest {
    Number mass, x, v;
    ParticleIndex index;
  };
  std::optional<Heaviest> left, right;
  Number mass, width;
};

/// Of tagged particles (core/observe/correlations.hpp).
struct TaggedMotion {
  std::vector<double> displacement, velocity;
};

/// What a guard found (core/observe/guards.hpp).
struct ReportedGuard {
  Guard guard = Guard::order;
  double found = 0, bound = 0;
  ParticleIndex particle = -1;
  Number time;
};

/// What of a run is measured at one time. What needs all particles is computed once, and only if a measurement requires
/// it.
class RunState {
 public:
  enum class Column { x, v, m, gap, closing_speed };

  explicit RunState(const RunTime& at) : time(at) {}
  RunState& operator=(RunState&&) = delete;
  virtual ~RunState() = default;

  const RunTime time;

  virtual const SampledState& state() const = 0;
  /// Of the particles in the configuration, and their numbers at the start.
  virtual std::vector<double> column(Column which) const = 0;
  virtual std::vector<std::string> column_text(Column which) const = 0;
  virtual const std::vector<ParticleIndex>& index() const = 0;
  /// The numbers of the outermost particles at the start.
  virtual std::pair<ParticleIndex, ParticleIndex> range() const = 0;
  /// The places of the outermost particles that have collided; of all, if none has.
  virtual BinRange ends() const = 0;
  /// The least and the median gap, and what closure misses, by name.
  virtual std::vector<std::pair<std::string, Number>> gap_numbers() const = 0;
  /// The state right after the last collision, of a run that ends with it.
  virtual std::unique_ptr<RunState> after_last_collision() const = 0;

  /// What a column was at the start of the run; the gap behind the last particle of a line is NaN.
  virtual std::vector<Number> at_start(Column which, ParticleIndex first, ParticleIndex last) const = 0;
  virtual Number circumference() const = 0;
  virtual double least_mass() const = 0;
  virtual Number energy_at_start() const = 0;

  virtual const SampledCloud& cloud() const = 0;
  virtual const DenseCore& core() const = 0;
  /// Of all particles of the scene under gravity.
  virtual Number potential_energy() const = 0;
  /// Energy minus that of the sticky gas from the same initial state.
  virtual Number sticky_excess() const = 0;
  virtual std::vector<std::uint64_t> mass_distribution() const = 0;
  /// Calls visit(particles) for every cluster: neighbours with gaps below this.
  virtual void for_each_cluster(const Decimal& gap, const std::function<void(std::size_t)>& visit) const = 0;
  virtual TaggedMotion tagged() const = 0;

  // What visits all particles, and throws WalkStopped where `stopped` stops it.
  virtual void find(TimeAverages& averages, const Stopped& stopped) const = 0;
  virtual void find(ZoneAverage& zone, const Stopped& stopped) const = 0;
  virtual std::vector<double> measured(const StructureFactor& structure, const Stopped& stopped) const = 0;
  virtual std::vector<double> measured(const PairDistribution& pairs, const Stopped& stopped) const = 0;
  virtual Profile profile(BinRange range, std::size_t bins, const Stopped& stopped) const = 0;
  virtual void sample(ScenarioWatch& watch) const = 0;

  /// Names what is beyond the range of the type: in the state, or of all particles. Null if nothing is.
  virtual const char* beyond_range(bool of_particles) const = 0;
  virtual std::optional<ReportedGuard> beyond_a_wall() const = 0;

  /// The left particle of a collision up to this time that rounding may add or remove.
  virtual std::optional<ParticleIndex> uncertain() const = 0;
  /// What the ledger leaves of the energy minus the sums over particles.
  virtual double ledger_error() const = 0;
  /// About how far rounding has moved the kinetic energy, as a share of this positive one; none if the engine does not
  /// estimate it.
  virtual std::optional<double> energy_deviation(double of) const = 0;
};

// ---- the engine

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
