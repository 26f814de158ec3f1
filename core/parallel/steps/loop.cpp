#include "cradle/core/parallel/steps/loop.hpp"

#include <algorithm>

namespace cradle {

// Steps are as long as some four passes take: the densest part decides. Where a step fails, those since the last undo
// copy are undone and made again, shorter ones.
bool run_steps(Step step, Step step_with_lags, StepLine& line, const StepTask& task, StepScalars& scalars,
               StepPace& pace, StepResult& result) {
  constexpr int passes_wanted = 4, most_failures = 6, least_stretch = 4, most_stretch = 400;
  double now = line.least_due(), kept_at = now;
  StepResult kept;
  if (!(pace.length > 0)) pace.length = (task.stop - now) / 1024;
  for (int left = 0, failures = 0; now <= task.stop; --left) {
    if (left == 0) {
      line.keep(), scalars.keep();
      kept = result, kept_at = now;
      if (failures == 0) pace.stretch = std::min(pace.stretch + pace.stretch / 4, most_stretch);
      left = pace.stretch, failures = 0;
    }
    const double end = std::min(now + pace.length, task.stop);
    const int passes = (line.lags ? step_with_lags : step)(line, task, scalars, end, result);
    if (passes < 0) {
      if (++failures > most_failures || !(now + pace.length / 4 > now)) return false;
      line.restore(), scalars.restore();
      result = kept, now = kept_at;
      pace.length /= 4, pace.stretch = std::max(pace.stretch / 2, least_stretch), left = pace.stretch + 1;
      continue;
    }
    if (result.collisions >= task.most || !(result.lost < task.rounder)) return false;
    if (end == task.stop) return true;
    now = end;
    pace.length *= passes > passes_wanted ? 0.8 : passes < passes_wanted ? 1.1 : 1;
  }
  return true;
}

}  // namespace cradle
