#include "cradle/core/parallel/steps/steps.hpp"

#include <algorithm>

namespace cradle {

// Steps are as long as some five passes take: the densest part decides. If a step fails, those since the last undo copy
// are undone and made again, as shorter ones, up to where it failed. Steps that leave collisions to the next one are
// some 5 % faster, but fail more often in the dense core of a shock: so they do only while none fails, and not where
// particles collapse, since a restitution that rises to 1 at low speeds lets them come apart again.
bool run_steps(Steps::Step step, StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace,
               StepResult& result) {
  constexpr int most_failures = 6, least_stretch = 4, most_stretch = 512, calm = 65536;
  constexpr std::uint64_t least_collisions = 6;  // in a step, for steps to pay
  double now = line.least_due(), kept_at = now, failed_at = now, shorter = 1;
  StepResult kept;
  if (!(pace.length > 0)) pace.length = (task.stop - now) / 1024;
  std::uint64_t steps = 0;
  for (int left = 0, failures = 0; now <= task.stop; --left) {
    if (left == 0) {
      line.keep(), scalars.keep();
      kept = result, kept_at = now;
      line.may_leave = pace.since_failure >= calm && task.law != StepLaw::of_speed;
      if (failures == 0) {
        pace.since_failure = std::min(pace.since_failure + pace.stretch, StepPace::most);
        pace.stretch = std::min(pace.stretch + pace.stretch / 16 + 1, most_stretch);
        pace.passes = std::min(pace.passes * 1.01, 5.);
      }
      left = pace.stretch, failures = 0;
    }
    if (!(now < failed_at)) shorter = 1;
    const double end = std::min(now + pace.length * shorter, task.stop);
    const int passes = step(line, task, scalars, end, result);
    if (passes < 0) {
      if (++failures > most_failures || !(now + pace.length * shorter / 4 > now)) return false;
      line.restore(), scalars.restore();
      result = kept, now = kept_at;
      failed_at = end, shorter /= 4, pace.since_failure = 0, line.may_leave = false;
      pace.passes = std::max(pace.passes * 0.95, 2.5), pace.length *= 0.9;
      pace.stretch = std::max(pace.stretch / 2, least_stretch), left = 4 * pace.stretch + 1;
      continue;
    }
    if (result.collisions >= task.most || !(result.lost < task.rounder)) return false;
    if (end == task.stop) return true;
    if (++steps % 256 == 0 && result.collisions < least_collisions * steps) return false;
    now = end;
    if (shorter == 1) pace.length *= passes > pace.passes ? 0.8 : passes < pace.passes - 1 ? 1.1 : 1.02;
  }
  return true;
}

}  // namespace cradle
