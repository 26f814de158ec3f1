// What the program needs to know of each collision law, one row per law. A new law is a class in core/ (its physics),
// its keys and its row here (tools/scene), and its lines in tools/engines/engine_of.hpp, where scenes become types
// (core/README.md). What the paper predicts for it, and what it costs, is a row in tools/theory/laws.cpp.
#pragma once

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct LawRow {
  LawType type;
  bool merges;        // particles stick or pass through each other; otherwise they bounce
  bool needs_events;  // false: the state at any time follows without collisions
  bool policies;      // run.collapse can be merge or contact-time
  bool provable;      // `certify` has its map in balls (tools/proof)
};

/// The row of the scene's law.
const LawRow& law_row(const Scene& scene);

/// Whether particles stick or pass through each other, by the law or by the collapse policy.
bool particles_merge(const Scene& scene);
/// Whether inelastic collapse is possible and ends the run.
bool stops_at_collapse(const Scene& scene);
/// Whether the state at each time is computed directly, without collisions.
bool without_collisions(const Scene& scene);

}  // namespace cradle::tools
