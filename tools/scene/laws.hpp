// The collision laws: what a scene says of its law, and what the program needs to know of each, one row per law. How a
// law is added is on the page of core/laws. What the paper predicts for it, and what it costs, is a row in
// tools/theory/laws.cpp.
#pragma once

#include <optional>
#include <string_view>

#include "cradle/tools/scene/decimal.hpp"
#include "cradle/tools/support/table.hpp"

namespace cradle::tools {

struct Scene;

enum class LawType { inelastic, wet, sticky };

namespace scene {

struct Law {
  LawType type = LawType::inelastic;
  Decimal restitution;  // inelastic
  Decimal cutoff;       // inelastic: closing speed below which collisions are elastic; 0: none
  std::optional<Decimal>
      cutoff_exponent;  // inelastic: the power of the speed with which the restitution falls; none: sharp
  Decimal loss;         // wet: E_loss
  bool operator==(const Law&) const = default;
};

}  // namespace scene

struct LawRow {
  LawType type;
  std::string_view name;     // as in scenes
  bool merges = false;       // particles stick or pass through each other; otherwise they bounce, also off walls
  bool needs_events = true;  // false: the state at any time follows without collisions
  bool policies = false;     // run.collapse can be merge or contact-time
  bool provable = false;     // `certify` has its map in balls (tools/proof)
};

inline constexpr LawRow law_rows[] = {
    {.type = LawType::inelastic, .name = "inelastic", .policies = true, .provable = true},
    {.type = LawType::wet, .name = "wet", .merges = true, .provable = true},
    {.type = LawType::sticky, .name = "sticky", .merges = true, .needs_events = false, .provable = true},
};
static_assert(rows_in_order(law_rows));

/// The row of the scene's law.
const LawRow& law_row(const Scene& scene);

/// Whether particles stick or pass through each other, by the law or by the collapse policy.
bool particles_merge(const Scene& scene);
/// Whether inelastic collapse is possible and ends the run.
bool stops_at_collapse(const Scene& scene);
/// Whether the state at each time is computed directly, without collisions.
bool without_collisions(const Scene& scene);

}  // namespace cradle::tools
