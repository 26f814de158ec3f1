// Observes a run: gets every collision before it is made, and a sample of the run at every output time. If an observer
// throws, the run ends.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cradle/core/engine/status.hpp"
#include "cradle/tools/record/rows.hpp"

namespace cradle::tools {

/// The particles of a snapshot: `from` and `to` are the numbers of the outermost ones at the start. Decimals have all
/// digits of the run's precision.
struct SampledParticles {
  ParticleIndex from = 0, to = -1;
  std::vector<ParticleIndex> index;
  std::vector<std::string> x, v, m;
};

/// The account of a wall since the start; decimals have all digits of the run's precision.
struct SampledWall {
  std::uint64_t collisions = 0;
  std::string given, momentum, dissipated;
};

struct SampledTime {
  double value = 0;
  std::string text = "0";
};

struct RunSample {
  SampledTime time;                      // its text and the decimals below have all digits of the run's precision
  long double epsilon = 0;               // of that precision
  std::vector<RequestedTime> requested;  // all requested times that the run's precision cannot distinguish from `time`
  bool of_series = false;
  bool at_collision = false;  // the run ends here, with its last collision
  Counts counts;
  std::string energy, front_left, front_right;  // fronts: empty before the first collision
  SampledParticles particles;                   // of a snapshot, else empty
  std::array<SampledWall, 2> walls;             // of the left one and of the right one
};

class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void collision(ParticleIndex left, ParticleIndex right, double time) = 0;
  virtual void sample(const RunSample& sample) = 0;
};

}  // namespace cradle::tools
