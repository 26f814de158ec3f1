#pragma once
// When each gap was last brought up to date, as an offset from the chain's origin of time. The chain keeps that local
// time with the gap; what it loses to rounding when the origin moves is kept here (`lag`), so that no gap is rounded by
// a move. The true local time is the sum of both. A lag is other than zero only where the local time is negative, and
// is looked up only there.

#include <vector>

#include "cradle/core/event_queue.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> class LocalTimes {
 public:
  void resize(std::size_t slots) { lag_.assign(slots, T(0)); }

  // Since the local time `then` of the gap s.
  [[gnu::always_inline]] T flown(Slot s, const T& then, const T& now) const {
    T way = now - then;
    if (is_negative(then)) [[unlikely]]
      way -= lag_[s];
    return way;
  }
  // The time when so long has passed since then.
  [[gnu::always_inline]] T after(Slot s, const T& then, const T& flight) const {
    T time = then + flight;
    if (is_negative(then)) [[unlikely]]
      time += lag_[s];
    return time;
  }

  // The gap is brought up to date.
  [[gnu::always_inline]] void renew(Slot s, T& then, const T& now) {
    if (is_negative(then)) [[unlikely]]
      lag_[s] = T(0);
    then = now;
  }
  // Where gaps come to other slots; 0 for one that is new.
  const T& lag(Slot s) const { return lag_[s]; }
  void set_lag(Slot s, const T& lag) { lag_[s] = lag; }

  // The origin moves by so much.
  void move(Slot s, T& then, const T& by) {
    const Pair<T> moved = two_sum(then, T(-by));
    then = moved.high;
    lag_[s] += moved.low;
  }

 private:
  std::vector<T> lag_;
};

}  // namespace cradle
