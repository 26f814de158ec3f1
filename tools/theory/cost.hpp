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
  std::optional<double> collapse;    // of inelastic collapse, if before the end
  double collisions_per_second = 0;
  double memory = 0;  // bytes
};

Cost expected_cost(const Scene& scene);

/// The expected collisions as a line, where they are known: how many, until which collapse, and what follows it.
std::string collisions_line(const Scene& scene, const Cost& cost);

/// That line if the run goes past a collapse, after which its collisions have no limit; else empty.
std::string past_collapse_warning(const Scene& scene);

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
