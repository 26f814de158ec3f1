// Observes a run: gets every collision before it is made, and a sample of the run at every output time. If an observer
// throws, the run ends.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/engines/run_state.hpp"
#include "cradle/tools/record/schedule.hpp"

namespace cradle::tools {

/// The particles of a snapshot, and the numbers of the outermost ones at the start. Decimals have all digits of the
/// run's precision.
struct SampledParticles {
  std::pair<ParticleIndex, ParticleIndex> range{0, -1};
  std::vector<ParticleIndex> index;
  std::vector<std::string> x, v, m;
};

struct RunSample {
  RunSample(const RunState& now, const Scene& scene, const Schedule& plan, long double epsilon_, bool at_collision_)
      : time(now.time), state(now.state()), epsilon(epsilon_),
        requested(plan.requested(scene, time.exact, at_collision_)), of_series(plan.series().hold(time.exact)),
        at_collision(at_collision_) {
    using enum RunState::Column;
    if (!at_collision && plan.snapshots().hold(time.exact))
      particles = {now.range(), now.index(), now.column_text(x), now.column_text(v), now.column_text(m)};
  }

  RunTime time;
  SampledState state;
  long double epsilon;                   // of the run's precision
  std::vector<RequestedTime> requested;  // all requested times that this precision cannot distinguish from `time`
  bool of_series;
  bool at_collision;           // the run ends here, with its last collision
  SampledParticles particles;  // of a snapshot, else empty
};

class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void collision(ParticleIndex left, ParticleIndex right, double time) = 0;
  virtual void sample(const RunSample& sample) = 0;
};

}  // namespace cradle::tools
