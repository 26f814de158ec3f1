// Observes a run: is notified of every collision before it is made, and receives a sample of the run at every output
// time. What an observer throws ends the run.
#pragma once

#include <string>
#include <vector>

#include "cradle/core/engine/status.hpp"
#include "cradle/tools/scene/decimal.hpp"

namespace cradle::tools {

/// A time that a run is recorded at: the decimal that the scene asks for or, where it asks for none, that of the run.
struct RequestedTime {
  Decimal time;
  bool of_series = false, of_snapshots = false;
  bool last = false;  // the run is to reach it
};

/// Particles of a snapshot, from the one numbered `from` at the start to the one numbered `to`, as decimals with all
/// digits of the run's precision.
struct SampledParticles {
  ParticleIndex from = 0, to = -1;
  std::vector<ParticleIndex> index;
  std::vector<std::string> x, v, m;
};

struct RunSample {
  double time = 0;
  std::string time_text;                 // with all digits of the run's precision, as are energy and fronts
  long double epsilon = 0;               // of that precision
  std::vector<RequestedTime> requested;  // all that the run's precision cannot distinguish from its time
  bool of_series = false;
  bool at_collision = false;  // the run ends here, with the collision that it made last
  Counts counts;
  std::string energy, front_left, front_right;  // fronts: empty before the first collision
  SampledParticles particles;                   // of a snapshot
};

class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void collision(ParticleIndex left, ParticleIndex right, double time) = 0;
  virtual void sample(const RunSample& sample) = 0;
};

}  // namespace cradle::tools
