// Checks during a run: of all particles after a number of collisions, and of every number before it is recorded. A
// failed check ends the run by an Error (Exit::lost).
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>

#include <fmt/format.h>

#include "cradle/core/observe/guards.hpp"
#include "cradle/tools/engines/engine.hpp"
#include "cradle/tools/run/report.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/initial_state.hpp"

namespace cradle::tools {

template <Real T> class RunGuards {
  static constexpr std::uint64_t collisions_between = 256;  // per particle; half as many before the end
  static constexpr std::uint64_t most_guarded = 1 << 22;    // with more particles a check would double the memory

 public:
  RunGuards(const Scene& scene, const cradle::Particles<T>& particles, const Engine<T>& engine)
      : scene_(scene), particles_(particles), engine_(engine), energy_(particles.mechanical_energy()),
        start_(number<T>(scene.run.start)), last_before_(start_) {}

  /// Checks all particles if that is due. Checks take about a hundredth of the time of the collisions. Whether one is
  /// due depends on the count of collisions, not on the clock, so that a failing run always stops at the same place.
  void check(const T& time, bool at_end) {
    require_between_walls(time);
    const std::uint64_t collisions = engine_.counts().collisions;
    const auto active = static_cast<std::uint64_t>(std::max<ParticleIndex>(engine_.collided_particles(), 16));
    const std::uint64_t between = collisions_between / (at_end ? 2 : 1);
    const bool put_off = checked_at_ > collisions && !at_end;
    const bool due = checked_at_ > collisions ? last_before_ < engine_.last_collision_time()  // the end is checked
                                              : collisions >= checked_at_ + between * active;
    if (!put_off && due && active <= most_guarded) check_all(time);
  }
  /// Checks a loaded state at once: a well-formed state may still not be one of this run.
  void check_loaded(const T& time) {
    const std::uint64_t before = checked_at_;
    if (static_cast<std::uint64_t>(engine_.collided_particles()) <= most_guarded) check_all(time);
    checked_at_ = before;
  }

  /// Throws if a particle is beyond a wall, at a time not before the last collision.
  void require_between_walls(const T& time) const {
    if (const auto found = beyond_a_wall(engine_, particles_, time, T(time - start_))) stop(*found, time);
  }

  /// Throws if the number is beyond the type's range: all that follows would be noise.
  void require_held(const T& number, const char* what, const T& time) const {
    if (is_finite(number)) return;
    throw Error({scene_.name, 0, ""}, fmt::format("{} beyond the range of {}", what, precision_name(scene_.run)),
                "at t = " + to_text(time), "give an earlier run.until, smaller speeds or a wider run.precision",
                Exit::lost);
  }
  void require_held(const Configuration<T>& now) const {
    for (const T& x : now.x) require_held(x, "a position", now.time);
    for (const T& v : now.v) require_held(v, "a velocity", now.time);
  }

  void require_held(const Sample<T>& now) const {
    require_held(now.energy, "the energy", now.time);
    for (const auto& front : {now.front_left, now.front_right})
      if (front) require_held(*front, "a front", now.time);
  }

  /// Has the smallest gap and the closure errors of the last check.
  RunStatus status(double time) const {
    RunStatus now = status_;
    now.time = time, now.collisions = engine_.counts().collisions;
    return now;
  }

  static auto state(auto& self) { return std::tie(self.checked_at_, self.last_before_); }

 private:
  [[noreturn]] void stop(const GuardReport<T>& broken, const T& time) const {
    throw Error(guard_message(reported(broken, time), reported(engine_.account()), scene_.run), Exit::lost);
  }
  void check_all(const T& time) {
    const std::uint64_t collisions = engine_.counts().collisions;
    const Account<T>& account = engine_.account();
    const Configuration<T> now = engine_.configuration(time);
    const GuardCheck<T> found =
        guarded(now, particles_, collisions, T(energy_ - engine_.energy_lost(time)), T(time - start_),
                engine_.last_collision_time(), last_before_, account.order_lost + account.unresolved == 0);
    if (found.broken) stop(*found.broken, time);
    // A check also visits merged particles, so the next one, except for that at the end, is delayed by their number.
    const auto merged = static_cast<std::uint64_t>(now.to - now.from + 1) - now.x.size();
    checked_at_ = collisions + collisions_between * merged;
    last_before_ = engine_.last_collision_time();
    status_.gap_min = to_double(found.gap_min);
    status_.closure_gap = to_double(found.closure_gap);
    status_.closure_speed = to_double(found.closure_speed);
  }

  const Scene& scene_;
  const cradle::Particles<T>& particles_;
  const Engine<T>& engine_;
  T energy_, start_;
  std::uint64_t checked_at_ = 0;  // at the last check of all particles
  T last_before_;                 // the time of the last collision before that check
  RunStatus status_;
};

}  // namespace cradle::tools
