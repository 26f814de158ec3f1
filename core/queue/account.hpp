#pragma once
// The account counts what a run could not resolve; nothing is clamped or skipped. Its numbers are of the scalar type,
// or of what stands for that in a report.

#include <cstdint>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

// The place and time of an event in a run that a report names.
template <class T> struct Incident {
  T time{0};
  ParticleIndex particle = -1;  // the particle on the left of the gap
  T gap{0};
  static auto state(auto& self) { return fields(self.time, self.particle, self.gap); }
};

template <class T> struct Account {
  // Gaps that were zero, or negative by no more than rounding, at a neighbouring collision: three particles met. The
  // tie rule (earlier time, then further left) decides the outcome.
  std::uint64_t simultaneous = 0;
  // Gaps that were negative beyond rounding: a collision came too late in the order of events.
  std::uint64_t order_lost = 0;
  Incident<T> first_order_lost;
  // Positions only: gaps next to a collision below 1e6 units in the last place of the position.
  std::uint64_t unresolved = 0;
  Incident<T> first_unresolved;
  // In watched chains (watched_gap.hpp) and closed systems: 1 from the first collision on that rounding may have
  // decided. `gap` is the possible error of that collision's gap.
  std::uint64_t uncertain = 0;
  Incident<T> first_uncertain;

  static auto state(auto& self) {
    return fields(self.simultaneous, self.order_lost, self.first_order_lost, self.unresolved, self.first_unresolved,
                  self.uncertain, self.first_uncertain);
  }

  // Enters a gap that is not positive although no collision was made there.
  void enter(const Incident<T>& closed, const T& rounding) {
    if (-closed.gap > rounding) {
      if (order_lost++ == 0) first_order_lost = closed;
    } else {
      ++simultaneous;
    }
  }
};

}  // namespace cradle
