#pragma once
// What a chain reports of a contact to the event loop.

#include "cradle/core/event_queue.hpp"
#include "cradle/core/law.hpp"
#include "cradle/core/notice.hpp"

namespace cradle {

// The law's outcome and the next contacts of the three gaps involved, as queue times.
template <Real T> struct Collision {
  Outcome<T> outcome;
  double due_left, due, due_right;
  Notice notice;
  Slot left, right;  // of the gaps on either side
};

}  // namespace cradle
