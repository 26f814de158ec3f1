#pragma once
// The beginning of a cell of a chain in gaps (timed_gaps.hpp): a gap and the local time of its last update.

#include <tuple>

#include "cradle/core/base/real.hpp"
#include "cradle/core/queue/event_queue.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

// `lost`: the energy lost in collisions here. `fits`: whether the values can be those of a gap with this closing speed.
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
// In double the time of the next collision is its own key. It is stored, which saves a division at the collision.
template <> struct TimedGap<double> {
  double gap = 1, time = 0, due = EventQueue::never;
  bool fits(double closing) const {
    return is_finite(gap) && is_finite(time) && is_finite(closing) &&
           (closing > 0 ? due == due : due == EventQueue::never);
  }
  static auto state(auto& self) { return std::tie(self.gap, self.time, self.due); }
};

}  // namespace cradle
