// Checks during a run: of all particles after a number of collisions, and of every number before it is recorded. A
// failed check ends the run by an Error (Exit::lost).
#pragma once

#include <cstdint>
#include <tuple>

#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/sink.hpp"

namespace cradle::tools {

class RunGuards {
 public:
  RunGuards(const Scene& scene, AnyEngine& engine) : scene_(scene), engine_(engine) {}

  void begin_again() { checked_at_ = 0, status_ = {}; }
  /// Checks all particles if that is due. Checks take about a hundredth of the time of the collisions. Whether one is
  /// due depends on the count of collisions, not on the clock, so that a failing run always stops at the same place.
  void check(const RunState& now, bool at_end);
  /// Checks a loaded state at once: a well-formed state may still not be one of this run.
  void check_loaded(const Number& time);

  /// Throws if a particle is beyond a wall, at a time not before the last collision.
  void require_between_walls(const RunState& now) const;
  /// Throws if a number of the state, or of any particle, is beyond the type's range: all that follows would be noise.
  void require_held(const RunState& now, bool of_particles) const;

  /// Has the smallest gap and the closure errors of the last check.
  RunStatus status(double time) const;

  static auto state(auto& self) { return std::tie(self.checked_at_); }

 private:
  [[noreturn]] void stop(const ReportedGuard& broken) const;
  void check_all(const Number& time);

  const Scene& scene_;
  AnyEngine& engine_;
  std::uint64_t checked_at_ = 0;  // at the last check of all particles
  RunStatus status_;
};

}  // namespace cradle::tools
