// Decides whether three particles collapse, in rational numbers from the scene's decimals: collision by collision until
// the condition of the theorem in core/engine/README.md holds or fails. Nothing is rounded, so there is one answer
// however near to a threshold; a run would need more collisions the nearer it is.
#pragma once

#include <cstdint>
#include <optional>

#include "cradle/tools/scene/scene.hpp"

namespace cradle::tools {

struct ExactCollapse {
  bool collapse = false;         // before the end of the run
  std::uint64_t collisions = 0;  // made until that was decided
};

/// Nothing for other scenes, and where it stays open: two collisions at one time, a time of collapse that is just the
/// end of the run, or no decision within some sixty collisions.
std::optional<ExactCollapse> exact_collapse(const Scene& scene);

}  // namespace cradle::tools
