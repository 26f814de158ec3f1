#pragma once
// Operations on all timed gaps at once (timed_gaps.hpp): moves of the origin of time, and changes of slots.

#include "cradle/core/chains/timed_gaps.hpp"

namespace cradle {

template <Real T, std::derived_from<TimedGap<T>> Cell, bool may_collapse>
inline void TimedGaps<T, Cell, may_collapse>::lay_out(std::size_t slots, Slot first, const std::vector<Slot>& kept) {
  std::vector<Cell> cells(slots);
  std::vector<T> lag(slots, T(0));
  for (const Slot s : kept) {
    cells[first] = std::move(cells_[s]);
    lag[first++] = std::move(lag_[s]);
  }
  cells_ = std::move(cells);
  lag_ = std::move(lag);
}

template <Real T, std::derived_from<TimedGap<T>> Cell, bool may_collapse>
template <class EachHeld>
inline void TimedGaps<T, Cell, may_collapse>::move_origin(const T& by, const EachHeld& each_held) {
  clock_.move_origin(by);
  if (magnitude(by) > blur_) blur_ = rounding_of(magnitude(by));
  each_held([&](Slot s, const T& closing) {
    const Pair<T> moved = two_sum(cells_[s].time, T(-by));
    const T lag = lag_[s] + moved.low;
    const bool past = is_negative(moved.high);  // false after a late collision, which has left it ahead of the origin
    cells_[s].time = past ? moved.high : T(moved.high + lag);
    lag_[s] = past ? lag : T(0);
    foresee(s, closing);
  });
  if constexpr (beyond_double) choose_shift(each_held);
}

template <Real T, std::derived_from<TimedGap<T>> Cell, bool may_collapse>
template <class EachHeld>
inline void TimedGaps<T, Cell, may_collapse>::choose_shift(const EachHeld& each_held) {
  long least = std::numeric_limits<long>::max();
  each_held([&](Slot s, const T& closing) {
    if (!is_positive(closing)) return;
    const T next = collision_time(s, closing);
    long exponent = 0;
    if (split(next, exponent) > 0) least = std::min(least, exponent);
  });
  shift_ = least < -500 || (least > 500 && least < std::numeric_limits<long>::max()) ? -least : 0;
}

}  // namespace cradle
