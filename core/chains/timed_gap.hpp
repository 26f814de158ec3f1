#pragma once
// What a cell of a chain in gaps begins with (timed_gaps.hpp): a gap and the local time at which it was last brought up
// to date.

#include <tuple>

#include "cradle/core/engine/event_queue.hpp"
#include "cradle/core/engine/ledger.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

// `lost`: the energy lost in collisions here. `fits`: whether it can be that of a gap closing at such a speed.
template <Real T> struct TimedGap {
  T gap{1}, time{0}, lost{0};
  bool fits(const T& closing) const {
    return is_finite(gap) && is_finite(time) && is_finite(lost) && is_finite(closing);
  }
  static auto state(auto& self) { return std::tie(self.gap, self.time, self.lost); }
};
template <Real T>
requires(Ledger<T>::in_any_order) struct TimedGap<T> {
  T gap{1}, time{0};
  bool fits(const T& closing) const { return is_finite(gap) && is_finite(time) && is_finite(closing); }
  static auto state(auto& self) { return std::tie(self.gap, self.time); }
};
// In double the time of the next collision is its own key: it is kept, which saves a division when it comes.
template <> struct TimedGap<double> {
  double gap = 1, time = 0, due = EventQueue::never;
  bool fits(double closing) const {
    return is_finite(gap) && is_finite(time) && is_finite(closing) &&
           (closing > 0 ? due == due : due == EventQueue::never);
  }
  static auto state(auto& self) { return std::tie(self.gap, self.time, self.due); }
};

}  // namespace cradle
