#pragma once
// Whether time advances. Many particles may meet at one time and place, n(n - 1)/2 collisions if they are elastic.
// Where more follow each other without any time passing, the scalar type cannot distinguish their times, or they have
// no end: particles soft enough continue until their speeds underflow.
//
// A law with a threshold ends them (README.md, Collapse), but late: soft particles in touch even out their speeds, w of
// them to the cut-off delta, in up to n^2 w/(2 delta) collisions, of which every one waits for those on its left.
//
// Offsets from a moving origin distinguish times for as long as a type's exponents last, which may be for ever. So
// there is a second bound, the same in every type: collisions at one time since the start, as the type holds it. A
// collapse may end there by a cut-off, and n particles can collapse only if 1 - eps is some pi/n or more: then their
// speeds fall by a factor exp(x) within n^2 x/pi collisions, and the bound allows for a factor of 10^5000.

#include <cstdint>
#include <tuple>

#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct Standstill {
  // `threshold`: the law has one, below which collisions lose less and less, or nothing.
  explicit Standstill(const T& start, bool threshold = false) : time(start), threshold_(threshold) {}

  T time;                             // local, at the last review
  T elapsed{0};                       // since the start, when that was last found to advance
  std::uint64_t collisions_then = 0;  // made when either was last found to advance
  std::uint64_t collisions_at_elapsed = 0;
  static auto state(auto& self) {
    return std::tie(self.time, self.elapsed, self.collisions_then, self.collisions_at_elapsed);
  }

  // At a review: local time now, time since the start, collisions made, particles active. `endless`: collisions at one
  // time since the start have no bound.
  bool at(const T& now, const T& since_start, std::uint64_t collisions, std::uint64_t active, bool endless) {
    if (now > time) collisions_then = collisions;
    if (since_start > elapsed) elapsed = since_start, collisions_at_elapsed = collisions;
    const std::uint64_t long_ones = (1 << 20) + 4096 * active * active;
    return collisions - collisions_then > (threshold_ ? long_ones : 64 + 4 * active * active) ||
           (!endless && collisions - collisions_at_elapsed > long_ones);
  }
  // An epoch has ended; the local time is called `now` since.
  void epoch_ended(const T& now, const T& since_start, std::uint64_t collisions) {
    time = now, collisions_then = collisions;
    if (since_start > elapsed) elapsed = since_start, collisions_at_elapsed = collisions;
  }

 private:
  bool threshold_;
};

}  // namespace cradle
