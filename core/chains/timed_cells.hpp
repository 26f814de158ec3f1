#pragma once
// The cells of timed gaps (timed_gaps.hpp), each with the rounding of its local time, and what becomes of a gap by its
// own collisions and those beside it.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/base/large_pages.hpp"
#include "cradle/core/base/real.hpp"
#include "cradle/core/queue/event_queue.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

// The beginning of a cell: a gap and the local time of its last update. `lost`: the energy lost in collisions here.
// `fits`: whether the values can be those of a gap with this closing speed.
template <Real T> struct TimedGap {
  T gap{1}, time{0}, lost{0};
  bool fits(const T& closing) const {
    return is_finite(gap) && is_finite(time) && is_finite(lost) && is_finite(closing);
  }
  static auto state(auto& self) { return fields(self.gap, self.time, self.lost); }
};
template <Real T>
requires(Ledger<T>::in_any_order) struct TimedGap<T> {
  T gap{1}, time{0};
  bool fits(const T& closing) const { return is_finite(gap) && is_finite(time) && is_finite(closing); }
  static auto state(auto& self) { return fields(self.gap, self.time); }
};
// In double the time of the next collision is its own key. It is stored, which saves a division at the collision.
template <> struct TimedGap<double> {
  double gap = 1, time = 0, due = EventQueue::never;
  bool fits(double closing) const {
    return is_finite(gap) && is_finite(time) && is_finite(closing) &&
           (closing > 0 ? due == due : due == EventQueue::never);
  }
  static auto state(auto& self) { return fields(self.gap, self.time, self.due); }
};

template <Real T, std::derived_from<TimedGap<T>> Cell> class TimedCells {
 public:
  // What gaps are in, to be used again for others.
  struct Memory {
    LongArray<Cell> cells = {};
    LongArray<T> lag = {};
  };
  TimedCells() = default;
  explicit TimedCells(Memory memory) : cells_(std::move(memory.cells)), lag_(std::move(memory.lag)) {}
  Memory leave() { return {std::move(cells_), std::move(lag_)}; }

  // ---- slots
  std::size_t slots() const { return cells_.size(); }
  Cell& operator[](Slot s) { return cells_[s]; }
  const Cell& operator[](Slot s) const { return cells_[s]; }
  // Changes to so many slots. Those from `first` on get the contents of `kept`, which ascend, in that order; where none
  // moves to the right, in the memory that is there.
  void lay_out(std::size_t slots, Slot first, const std::vector<Slot>& kept) {
    if (kept.empty()) {
      cells_.assign(slots, Cell());
      lag_.assign(slots, T(0));
      return;
    }
    const auto rearrange = [&](auto& all, const auto& vacant) {
      std::remove_reference_t<decltype(all)> moved;
      const bool in_place = first <= kept.front();
      if (!in_place) moved.resize(slots, vacant);
      auto& to = in_place ? all : moved;
      Slot next = first;
      for (const Slot s : kept) {
        if (&to[next] != &all[s]) to[next] = std::move(all[s]);
        ++next;
      }
      if (!in_place) return all.swap(moved);
      all.resize(next, vacant), all.resize(slots, vacant);
      std::fill_n(all.begin(), first, vacant);
    };
    rearrange(cells_, Cell());
    rearrange(lag_, T(0));
  }
  // The same, with what make(k) returns for the k-th of those from `first` on.
  template <class Make> void fill(std::size_t slots, Slot first, std::size_t held, const Make& make) {
    cells_.clear();
    cells_.reserve(slots);
    cells_.resize(first);
    for (std::size_t k = 0; k < held; ++k) cells_.push_back(make(k));
    cells_.resize(slots);
    lag_.assign(slots, T(0));
  }
  void put(Slot s, Cell&& cell) {
    cells_[s] = std::move(cell);
    lag_[s] = T(0);
  }
  // Starts a gap that was not needed before.
  void start(Slot s, const T& gap, const T& now) {
    cells_[s].gap = gap;
    cells_[s].time = now;
    lag_[s] = T(0);
  }
  // Moves a gap to another slot.
  void carry(Slot from, Slot to) {
    cells_[to].gap = cells_[from].gap;
    cells_[to].time = cells_[from].time;
    lag_[to] = lag_[from];
    if constexpr (!Ledger<T>::in_any_order) cells_[to].lost += std::exchange(cells_[from].lost, T(0));
  }

  // ---- copies of a part (segments.hpp)
  void copy(const TimedCells& other, Slot from, Slot to) {
    cells_[to] = other.cells_[from];
    lag_[to] = other.lag_[from];
  }
  void copy(const TimedCells& other, Slot from, Slot to, std::size_t gaps) {
    std::copy_n(&other.cells_[from], gaps, &cells_[to]);
    std::copy_n(&other.lag_[from], gaps, &lag_[to]);
  }
  // Local times have changed; those that are not negative any more have no lag.
  void drop_lags(Slot first, std::size_t gaps) {
    for (Slot s = first; s < first + gaps; ++s) lag_[s] = is_negative(cells_[s].time) ? lag_[s] : T(0);
  }
  void set_lag(Slot s, const T& lag) { lag_[s] = lag; }
  void resize(std::size_t slots) {  // gaps are then put into so many slots
    cells_.resize(slots);
    lag_.resize(slots);
  }
  void swap_gaps(TimedCells& other) {
    cells_.swap(other.cells_);
    lag_.swap(other.lag_);
  }

  // ---- times
  const T& lag(Slot s) const { return lag_[s]; }
  // The time since the gap's local time.
  [[gnu::always_inline]] T flown(Slot s, const T& now) const {
    const T& then = cells_[s].time;
    T way = now - then;
    if (is_negative(then)) [[unlikely]]
      way -= lag_[s];
    return way;
  }
  // The time when a gap has aged by `wait` since its local time.
  T after(Slot s, const T& wait) const {
    const T time = cells_[s].time + wait;
    return is_negative(cells_[s].time) ? T(time + lag_[s]) : time;
  }
  T collision_time(Slot s, const T& closing) const {
    const Cell& cell = cells_[s];
    T time = cell.time + cell.gap / closing;
    if (is_negative(cell.time)) [[unlikely]]
      time += lag_[s];
    return time;
  }
  // The gap at a time not before its local time.
  T gap_at(Slot s, const T& closing, const T& time) const { return cells_[s].gap - closing * flown(s, time); }

  T lost(Slot s) const {
    if constexpr (Ledger<T>::in_any_order)
      return T(0);
    else
      return cells_[s].lost;
  }

  // ---- events

  // A collision at `time` beside the gap adds gain() to its closing speed. Returns the time since the local time, which
  // is negative if the collision is late.
  template <class Gain> [[gnu::always_inline]] T kick(Slot s, const T& closing, const Gain& gain, const T& time) {
    Cell& cell = cells_[s];
    const T since = flown(s, time);
    if (is_negative(since)) [[unlikely]]
      cell.gap += gain() * since;
    else {
      cell.gap -= closing * since;
      renew(s, time);
    }
    return since;
  }
  // A collision at the gap itself, after which it closes at a speed <= 0; `since` as above.
  [[gnu::always_inline]] void close(Slot s, const T& closing, const T& since, const T& time) {
    Cell& cell = cells_[s];
    if (is_negative(since)) [[unlikely]]
      cell.gap = closing * since;
    else {
      cell.gap = T(0);
      renew(s, time);
    }
  }

 protected:
  [[gnu::always_inline]] void renew(Slot s, const T& now) {
    T& then = cells_[s].time;
    if (is_negative(then)) [[unlikely]]
      lag_[s] = T(0);
    then = now;
  }

  LongArray<Cell> cells_;
  LongArray<T> lag_;
};

}  // namespace cradle
