// The state of a run at one time, of which everything is measured, for code that is the same for all scalar types. What
// needs all particles is computed once, and only if a measurement requires it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cradle/core/engine/status.hpp"
#include "cradle/core/observe/averages.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/observe/profile.hpp"
#include "cradle/core/observe/scenario.hpp"
#include "cradle/core/observe/structure.hpp"
#include "cradle/core/observe/zone.hpp"
#include "cradle/tools/engines/number.hpp"

namespace cradle::tools {

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

}  // namespace cradle::tools
