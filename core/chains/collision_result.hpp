#pragma once
// What a chain reports of a collision to the event loop.

#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// The requests of a chain to the event loop after a collision, handled off the hot path: a set, named by what to do.
enum class Notice : unsigned {
  none = 0,
  origin_should_move = 1,  // the flight before the collision was short: 2^-20 of the time since the origin
  origin_must_move = 2,    // so short, 2^-40, that time loses digits unless the origin moves now
  gap_below_floor = 4,     // the collision left a neighbouring gap below the floor (collapse, or a gap that has closed)
  needs_slots = 8          // the chain has no slot for the next particle of a row: lay it out anew
};

constexpr Notice operator|(Notice a, Notice b) {
  return static_cast<Notice>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr Notice& operator|=(Notice& a, Notice b) { return a = a | b; }
constexpr Notice when(bool holds, Notice notice) {
  return static_cast<Notice>(static_cast<unsigned>(holds) * static_cast<unsigned>(notice));
}
// Whether it has any of the others.
constexpr bool includes(Notice notices, Notice others) {
  return (static_cast<unsigned>(notices) & static_cast<unsigned>(others)) != 0;
}

// The request after a flight that ends at the given time since the origin, both as queue times.
[[gnu::always_inline]] inline Notice of_flight(double flown, double time) {
  return when(flown < time * 0x1p-20, Notice::origin_should_move) |
         when(flown < time * 0x1p-40, Notice::origin_must_move);
}

// The law's outcome and the next collisions of the three gaps involved, as queue times.
template <Real T> struct CollisionResult {
  Outcome<T> outcome;
  double due_left, due, due_right;
  Notice notice;
  Slot left, right;  // of the gaps on either side
};

}  // namespace cradle
