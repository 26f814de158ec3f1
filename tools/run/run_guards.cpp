#include "cradle/tools/run/run_guards.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cradle/tools/engines/precision.hpp"
#include "cradle/tools/run/report.hpp"

namespace cradle::tools {

namespace {

constexpr std::uint64_t collisions_between = 256;  // per particle; half as many before the end
constexpr std::uint64_t most_guarded = 1 << 22;    // with more particles a check would double the memory

}  // namespace

void RunGuards::check(const RunState& now, bool at_end) {
  require_between_walls(now);
  const std::uint64_t collisions = engine_.counts().collisions;
  const auto active = static_cast<std::uint64_t>(std::max<ParticleIndex>(engine_.collided_particles(), 16));
  const std::uint64_t between = collisions_between / (at_end ? 2 : 1);
  const bool put_off = checked_at_ > collisions && !at_end;
  const bool due = checked_at_ > collisions ? engine_.collided_since_check()  // the end is checked
                                            : collisions >= checked_at_ + between * active;
  if (!put_off && due && active <= most_guarded) check_all(now.time.exact);
}

void RunGuards::check_loaded(const Number& time) {
  const std::uint64_t before = checked_at_;
  if (static_cast<std::uint64_t>(engine_.collided_particles()) <= most_guarded) check_all(time);
  checked_at_ = before;
}

void RunGuards::require_between_walls(const RunState& now) const {
  if (const auto found = now.beyond_a_wall()) stop(*found);
}

void RunGuards::require_held(const RunState& now, bool of_particles) const {
  if (const char* what = now.beyond_range(of_particles))
    throw Error({scene_.name}, fmt::format("{} beyond the range of {}", what, precision_name(scene_.run)),
                "at t = " + now.time.exact.text(), "give an earlier run.until, smaller speeds or a wider run.precision",
                Exit::lost);
}

RunStatus RunGuards::status(double time) const {
  RunStatus now = status_;
  now.time = time, now.collisions = engine_.counts().collisions;
  return now;
}

void RunGuards::stop(const ReportedGuard& broken) const {
  throw Error(guard_message(broken, engine_.account(), scene_.run), Exit::lost);
}

void RunGuards::check_all(const Number& time) {
  const CheckedParticles found = engine_.check(time);
  if (found.broken) stop(*found.broken);
  // A check also visits merged particles, so the next one, except for that at the end, is delayed by their number.
  checked_at_ = engine_.counts().collisions + collisions_between * found.merged;
  status_.gap_min = found.gap_min;
  status_.closure_gap = found.closure_gap;
  status_.closure_speed = found.closure_speed;
}

}  // namespace cradle::tools
