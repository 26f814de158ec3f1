#pragma once
// What a chain reports of a collision to the event loop.

#include "cradle/core/chains/notice.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// The law's outcome and the next collisions of the three gaps involved, as queue times.
template <Real T> struct CollisionResult {
  Outcome<T> outcome;
  double due_left, due, due_right;
  Notice notice;
  Slot left, right;  // of the gaps on either side
};

}  // namespace cradle
