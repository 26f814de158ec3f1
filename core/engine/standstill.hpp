#pragma once
// `Standstill` detects that time does not advance. Many particles may meet at one time and place: n(n - 1)/2 collisions
// if they are elastic. README.md (When a type resolves no more) has the two bounds on collisions at one time, local and
// since the start, and says why the run ends beyond them.
//
// The second one allows for a collapse that a cut-off ends, or a gap at which the run is to stop. n particles can
// collapse only if 1 - eps is at least about pi/n: then their speeds fall by a factor exp(x) within n^2 x/pi
// collisions, and the bound allows for a factor of 10^5000, or for that of the smallest gap to the one at which the run
// stops, if it is more.

#include <cstdint>
#include <tuple>

#include "cradle/core/base/real.hpp"

namespace cradle {

template <Real T> struct Standstill {
  // `threshold`: the law has one, below which collisions lose less and less, or nothing. `followed`: by what factor
  // gaps shrink until the run stops, at least 1.
  explicit Standstill(const T& start, bool threshold = false, const T& followed = T(1))
      : time(start), threshold_(threshold) {
    T power(2);
    for (int squares = 0; squares < 14; ++squares) power *= power;  // 2^16384, infinite in types of a smaller range
    for (T next = power; next < followed; next *= power) ++times_;
  }

  T time;                             // local, at the last review
  T elapsed{0};                       // since the start, at the last advance of time
  std::uint64_t collisions_then = 0;  // number of collisions when time or elapsed advanced last
  std::uint64_t collisions_at_elapsed = 0;
  static auto state(auto& self) {
    return std::tie(self.time, self.elapsed, self.collisions_then, self.collisions_at_elapsed);
  }

  // Called at a review with local time, time since the start, collisions made and active particles. `shrinks` says that
  // the last collision was with a floor, and that the run stops when a rebound from it is small enough: absolute times
  // do not resolve rebounds, but their heights are known.
  bool at(const T& now, const T& since_start, std::uint64_t collisions, std::uint64_t active, bool shrinks = false) {
    if (now > time) collisions_then = collisions;
    if (since_start > elapsed) elapsed = since_start, collisions_at_elapsed = collisions;
    const std::uint64_t long_ones = (1 << 20) + 4096 * active * active;
    return collisions - collisions_then > (threshold_ || shrinks ? long_ones : 64 + 4 * active * active) ||
           collisions - collisions_at_elapsed > times_ * long_ones;
  }
  // An epoch has ended; its local time is now called `now`.
  void epoch_ended(const T& now, const T& since_start, std::uint64_t collisions) {
    time = now, collisions_then = collisions;
    if (since_start > elapsed) elapsed = since_start, collisions_at_elapsed = collisions;
  }

 private:
  bool threshold_;
  std::uint64_t times_ = 1;  // and one more for each power of 2^16384 below `followed`
};

}  // namespace cradle
