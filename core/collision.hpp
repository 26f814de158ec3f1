#pragma once
// What a chain reports of a contact to the event loop.

#include "cradle/core/event_queue.hpp"
#include "cradle/core/law.hpp"

namespace cradle {

// Why a contact wants a closer look; a set of bits.
using Notice = unsigned;
namespace notice {
inline constexpr Notice none = 0;
inline constexpr Notice crowded = 1;   // the flight before it was short against the time since the origin, 2^-20 of it
inline constexpr Notice pressing = 8;  // so short, 2^-40, that time loses its digits unless the origin moves now
inline constexpr Notice tight = 2;     // it left a gap below the floor beside it
inline constexpr Notice cramped = 4;   // the chain has no slot for the next body of a row

// Of a flight that ends at the given time since the origin, both as queue times.
[[gnu::always_inline]] inline Notice of_flight(double flown, double time) {
  return crowded * (flown < time * 0x1p-20) | pressing * (flown < time * 0x1p-40);
}
}  // namespace notice

// The law's outcome and the next contacts of the three gaps involved, as queue times.
template <Real T> struct Collision {
  Outcome<T> outcome;
  double due_left, due, due_right;
  Notice notice;
  Slot left, right;  // of the gaps on either side
};

}  // namespace cradle
