// The cost of a run, estimated before it starts: collisions by the laws of the shock and of gases, time by the speed of
// each scalar type, memory by the bytes per particle. Orders of magnitude, for planning.
#pragma once

#include <optional>
#include <string>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct Cost {
  double particles = 0;              // in the active zone at the end, at most
  std::optional<double> collisions;  // none: not known for this initial state
  std::optional<double> collapse;    // of inelastic collapse, if before the end; collisions: until then
  std::optional<double> clustering;  // of a gas that cools, likewise
  bool floor = false;                // on which particles may collapse, at a time that is not known
  std::string endless = {};          // a line, if nothing ends the run where particles collapse
  double collisions_per_second = 0;
  double memory = 0;  // bytes

  /// Whether the pace of a run says how long the rest takes.
  bool predictable() const { return !collapse && !clustering && !floor; }
};

Cost expected_cost(const Scene& scene);

/// What is expected, in lines: how many collisions, until which collapse or clustering, what follows it, where the run
/// ends then and what ends it sooner or takes it past; or that nothing is known.
std::string expected_lines(const Scene& scene, const Cost& cost);

/// A number of so many digits without a power of ten below a million: 1000, not 1e+03.
std::string about(double x, int digits = 2);

/// These lines if the run ends at a collapse, goes past it or past clustering, or may have no end; else empty.
std::string expected_warning(const Scene& scene);

// Expected collisions of two equal rows, by law (laws.cpp).
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
