// What a run of a scene will cost, before it is run: collisions by the laws of the shock, time by how many collisions a
// second each scalar type makes, memory by what a particle takes in it. Orders of magnitude, to plan with.
#pragma once

#include <optional>
#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct Cost {
  double particles = 0;              // in the active zone at the end, at most
  std::optional<double> collisions;  // none: not known beforehand for this initial state
  std::optional<double> collapse;    // time from which on collisions have no limit, where that is before the end
  double collisions_per_second = 0;
  double memory = 0;  // bytes
};

Cost expected_cost(const Scene& scene);

// Collisions of two equal rows, by law (tools/model/laws.hpp).
void bouncing_rows(const Scene& scene, Cost& cost);
void wet_rows(const Scene& scene, Cost& cost);
void sticky_rows(const Scene& scene, Cost& cost);

/// What threads do for one run: how many times as fast it gets, at its end, or why it stays on one.
struct Threading {
  double gain = 1;
  std::string alone;  // empty: in segments
};
Threading expected_threading(const Scene& scene, const Cost& cost, unsigned threads);

}  // namespace cradle::tools
