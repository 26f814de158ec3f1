// The cost of a run, estimated before it starts: collisions by the laws of the shock, time by the speed of each scalar
// type, memory by the bytes per particle. Orders of magnitude, for planning.
#pragma once

#include <optional>
#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct Cost {
  double particles = 0;              // in the active zone at the end, at most
  std::optional<double> collisions;  // none: not known for this initial state
  std::optional<double> collapse;    // time after which the number of collisions has no limit, if before the end
  double collisions_per_second = 0;
  double memory = 0;  // bytes
};

Cost expected_cost(const Scene& scene);

// Expected collisions of two equal rows, by law (tools/model/laws.hpp).
void bouncing_rows(const Scene& scene, Cost& cost);
void wet_rows(const Scene& scene, Cost& cost);
void sticky_rows(const Scene& scene, Cost& cost);

/// What threads gain for one run: the speed-up at its end, or the reason why it uses one.
struct Threading {
  double gain = 1;
  std::string alone;  // the reason; empty: several threads
};
Threading expected_threading(const Scene& scene, const Cost& cost, unsigned threads);

}  // namespace cradle::tools
