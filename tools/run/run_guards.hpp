// Checks during a run: of all particles after a number of collisions, and of every number before it is recorded. A
// failed check ends the run by an Error (Exit::lost).
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "cradle/core/base/fields.hpp"
#include "cradle/tools/engines/any_engine.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/sink.hpp"

namespace cradle::tools {

class RunGuards {
 public:
  RunGuards(const Scene& scene, AnyEngine& engine) : scene_(scene), engine_(engine) {}

  void begin_again() { counted_from_ = 0, status_ = {}; }
  /// Checks all particles if that is due. Checks take about a hundredth of the time of the collisions. Whether one is
  /// due depends on the count of collisions, not on the clock, so that a failing run always stops at the same place.
  void check(const RunState& now, bool at_end) {
    require_between_walls(now);
    const std::uint64_t collisions = engine_.counts().collisions;
    const auto active = static_cast<std::uint64_t>(std::max<ParticleIndex>(engine_.collided_particles(), 16));
    const std::uint64_t between = collisions_between / (at_end ? 2 : 1);
    const bool put_off = counted_from_ > collisions && !at_end;
    // A check that is put off is made at the end if anything has collided since the last one.
    const bool due =
        counted_from_ > collisions ? engine_.collided_since_check() : collisions >= counted_from_ + between * active;
    if (!put_off && due && active <= most_guarded) check_all(now.time.exact);
  }
  /// Checks a loaded state at once: a well-formed state may still not be one of this run.
  void check_loaded(const Number& time) {
    const std::uint64_t before = counted_from_;
    if (static_cast<std::uint64_t>(engine_.collided_particles()) <= most_guarded) check_all(time);
    counted_from_ = before;
  }

  /// Throws if a particle is beyond a wall, at a time not before the last collision.
  void require_between_walls(const RunState& now) const {
    if (const auto found = now.beyond_a_wall()) stop(*found);
  }
  /// Throws if a number of the state, or of any particle, is beyond the type's range: all that follows would be noise.
  void require_held(const RunState& now, bool of_particles) const {
    if (const char* what = now.beyond_range(of_particles))
      throw Error({scene_.name}, fmt::format("{} beyond the range of {}", what, precision_name(scene_.run)),
                  "at t = " + now.time.exact.text(),
                  "give an earlier run.until, smaller speeds or a wider run.precision", Exit::lost);
  }

  /// Has the smallest gap and the closure errors of the last check.
  RunStatus status(double time) const {
    RunStatus now = status_;
    now.time = time, now.collisions = engine_.counts().collisions;
    return now;
  }

  static auto state(auto& self) { return fields(self.counted_from_); }

 private:
  [[noreturn]] void stop(const ReportedGuard& broken) const {
    throw Error(guard_message(broken, engine_.account(), scene_.run), Exit::lost);
  }
  void check_all(const Number& time) {
    const CheckedParticles found = engine_.check(time);
    if (found.broken) stop(*found.broken);
    // A check also visits merged particles, so the next one, except for that at the end, is delayed by their number.
    counted_from_ = engine_.counts().collisions + collisions_between * found.merged;
    status_.gap_min = found.gap_min;
    status_.closure_gap = found.closure_gap;
    status_.closure_speed = found.closure_speed;
  }

  static constexpr std::uint64_t collisions_between = 256;  // per particle; half as many before the end
  static constexpr std::uint64_t most_guarded = 1 << 22;    // with more particles a check would double the memory

  const Scene& scene_;
  AnyEngine& engine_;
  std::uint64_t counted_from_ = 0;  // number of collisions from which those up to the next check are counted
  RunStatus status_;
};

}  // namespace cradle::tools
