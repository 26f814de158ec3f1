#include "cradle/core/parallel/steps/loop.hpp"

#include <algorithm>

namespace cradle {

// Steps are as long as some five passes take: the densest part decides. If a step fails, those since the last undo copy
// are undone and made again, as shorter ones, up to where it failed; if that does not help, what has been made up to
// the copy is of use where a part is. So is what comes before a flight that is too short.
bool run_steps(Step step, StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace,
               StepResult& result) {
  constexpr int most_failures = 6, least_stretch = 4, most_stretch = 512;
  constexpr std::uint64_t least_collisions = 6;  // in a step, for steps to pay
  double now = line.least_due(), kept_at = now, failed_at = now, shorter = 1;
  double stop = task.stop;
  const double begin = now;
  StepResult kept;
  if (!(pace.length > 0)) pace.length = (stop - now) / 1024;
  std::uint64_t steps = 0;
  // Whether what has been made up to a time is of use.
  const auto end_at = [&](double time) {
    result.reached = time, result.steps = steps;
    return time == task.stop || (task.partly && time > begin);
  };
  for (int left = 0, failures = 0; now <= stop; --left) {
    if (left == 0) {
      line.keep(), scalars.keep();
      kept = result, kept_at = now;
      if (failures == 0) {
        pace.stretch = std::min(pace.stretch + pace.stretch / 16 + 1, most_stretch);
        pace.passes = std::min(pace.passes * 1.01, 5.);
      }
      left = pace.stretch, failures = 0;
    }
    if (!(now < failed_at)) shorter = 1;
    const double end = std::min(now + pace.length * shorter, stop);
    const int passes = step(line, task, scalars, end, result);
    const std::uint64_t made = result.collisions + scalars.collisions;
    ++steps;
    if (passes < 0 || made >= task.most) {
      const bool again = ++failures <= most_failures && now + pace.length * shorter / 4 > now && made < task.most;
      if (!again && !task.partly) return false;
      line.restore(), scalars.restore();
      result = kept;
      if (!again) return end_at(kept_at);
      if (passes == short_flight && task.partly) {
        if (now == kept_at) return end_at(now);
        stop = now;
      } else {
        failed_at = end, shorter /= 4;
        pace.passes = std::max(pace.passes * 0.95, 2.5), pace.length *= 0.9;
        pace.stretch = std::max(pace.stretch / 2, least_stretch), left = 4 * pace.stretch + 1;
      }
      now = kept_at;
      continue;
    }
    if (!(result.lost < task.rounder)) return false;
    if (end == stop) return end_at(stop);
    if (task.partly && made + 3 * (made / steps) + 16 >= task.most) return end_at(end);
    if (steps % 256 == 0 && made < least_collisions * steps) return end_at(end);
    now = end;
    if (shorter == 1) pace.length *= passes > pace.passes ? 0.8 : passes < pace.passes - 1 ? 1.1 : 1.02;
  }
  return end_at(task.stop);
}

}  // namespace cradle
