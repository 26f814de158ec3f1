#pragma once
// The gaps of a chain, each with its local time: the time of its last update, an offset from a moving origin. Both
// chains in gaps share what is done here with a gap g that closes at the speed w; they store different speeds
// (gap_chain.hpp: closing speeds; cluster_chain.hpp: velocities, from which w follows):
//
//   next collision  local time + g/w, if w > 0
//   brought to t    g -= w (t - local time), local time = t
//   in collision    g = 0 exactly
//
// Collisions may come late, before the gap's local time: README.md (Late collisions) says what becomes of it then.
//
// When the origin moves, a local time is rounded. The rounding error is kept (`lag`; the true local time is the sum of
// both), so that a move changes no gap. A lag is nonzero only if the local time is negative, and is read only then.

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/chains/timed_cells.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/clock.hpp"
#include "cradle/core/queue/event_queue.hpp"
#include "cradle/core/queue/ledger.hpp"

namespace cradle {

template <Real T, std::derived_from<TimedGap<T>> Cell> class TimedGaps : public TimedCells<T, Cell> {
  using Cells = TimedCells<T, Cell>;

 public:
  using Cells::resize, Cells::flown, Cells::collision_time;
  static constexpr bool keys_are_exact = std::same_as<T, double>;
  static constexpr bool beyond_double = WiderRange<T>;  // gaps and times may be beyond the range of double

  TimedGaps(const T& start, const T& energy, typename Cells::Memory memory = {})
      : Cells(std::move(memory)), clock_(start), lost_(energy) {}

  // Changes to so many slots, and copies the clock, the floor, the unit of queue times and the grid of the ledger from
  // `other`. The ledger is empty; rounding is not accounted for here.
  void resemble(const TimedGaps& other, std::size_t slots) {
    resize(slots);
    clock_ = other.clock_;
    floor_ = other.floor_;
    shift_ = other.shift_;
    lost_ = other.lost_;
    lost_.clear();
  }
  void set_ledger(const Ledger<T>& ledger) { lost_ = ledger; }

  static auto state(auto& self) {
    return fields(self.cells_, self.lag_, self.clock_, self.floor_, self.blur_, self.shift_, self.account_, self.lost_);
  }
  void loaded() const {
    require_state(lag_.size() == cells_.size(), "lists");
    require_state(is_finite(blur_) && !is_negative(blur_), "times");
  }

  // ---- times
  const Clock<T>& clock() const { return clock_; }
  [[gnu::always_inline]] double queue_time(const T& local) const {
    if constexpr (beyond_double) {
      long exponent = 0;
      const double mantissa = split(local, exponent);
      return scale(mantissa, exponent + shift_);
    } else {
      return to_double(local);
    }
  }
  // The local time of a gap, as a time since the start.
  Pair<T> since_start(Slot s) const {
    const T& time = cells_[s].time;
    const Pair<T> since = clock_.since_start(time);
    return is_negative(time) ? since + lag_[s] : since;
  }
  // Local time of the next collision of a gap that is closing.
  T due(Slot s, const T& closing) const {
    if constexpr (keys_are_exact)
      return cells_[s].due;
    else
      return collision_time(s, closing);
  }
  double queue_due(Slot s, const T& closing) const {
    if constexpr (keys_are_exact)
      return cells_[s].due;
    else
      return is_positive(closing) ? queue_time(collision_time(s, closing)) : EventQueue::never;
  }
  // The smallest difference between two collision times that is resolved, as a time since the start.
  T time_resolution(const T& time) const {
    return T(std::numeric_limits<T>::epsilon()) * magnitude(clock_.elapsed(time));
  }
  // Predicts the next collision of a gap that has just changed, as a queue time. In wide types it is rounded; the queue
  // allows for that.
  [[gnu::always_inline]] double predict(Slot s, const T& closing) {
    Cell& cell = cells_[s];
    if constexpr (keys_are_exact) {
      return cell.due = if_closing(cell.time + cell.gap / closing, closing);
    } else {
      if (!is_positive(closing)) return EventQueue::never;
      // Exact times of float differ too much from those in double for the queue's slack.
      if (std::same_as<T, float> || is_negative(cell.time)) [[unlikely]]
        return queue_due(s, closing);
      if constexpr (beyond_double) {
        long of_gap = 0, of_closing = 0;
        const double gap = split(cell.gap, of_gap), speed = split(closing, of_closing);
        return in_range(queue_time(cell.time) + scale(gap / speed, of_gap - of_closing + shift_), s, closing);
      } else {
        return in_range(to_double(cell.time) + to_double(cell.gap) / to_double(closing), s, closing);
      }
    }
  }
  // The queue time of any gap; its collision has been predicted.
  double queue_key(Slot s, const T& closing) {
    if constexpr (keys_are_exact)
      return cells_[s].due;
    else
      return predict(s, closing);
  }
  // Predicts off the hot path, for a gap of any age.
  void foresee(Slot s, const T& closing) {
    // Only a gap with a negative local time has a lag.
    if constexpr (keys_are_exact)
      cells_[s].due = if_closing(cells_[s].time + cells_[s].gap / closing + lag_[s], closing);
  }
  void forget(Slot s) {
    if constexpr (keys_are_exact) cells_[s].due = EventQueue::never;
  }

  // Moves the origin of time. `each_held` calls its argument with every held gap and its closing speed.
  template <class EachHeld> void move_origin(const T& by, const EachHeld& each_held) {
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

  // ---- gaps to inspect: those that a neighbouring collision leaves below the floor
  void set_floor(const T& floor) { floor_ = floor; }
  const T& floor() const { return floor_; }
  bool below_floor(Slot s) const { return cells_[s].gap < floor_; }
  // Called for a gap below the floor after a neighbouring collision that has made it close faster by `gain`: `since` is
  // the result of kick, particle the one on its left, `struck` the time since the local time of the gap of the
  // collision. (Out of line and by value: inlined it costs the hot path 9 instructions per collision, of 410.)
  [[gnu::noinline, gnu::cold]] Notice note(Slot s, T closing, T gain, T since, T struck, ParticleIndex particle,
                                           T time) {
    if (!is_positive(cells_[s].gap))
      account_.enter({clock_.time(time), particle, cells_[s].gap}, below_zero(s, closing, gain, since, struck, time));
    return Notice::gap_below_floor;
  }
  void doubt(const Incident<T>& collision) {
    if (account_.uncertain++ == 0) account_.first_uncertain = collision;
  }
  const Account<T>& account() const { return account_; }

  // ---- energy lost in a collision at the gap; in all gaps from one slot to another
  [[gnu::always_inline]] void lose(Slot s, const T& energy) {
    if constexpr (Ledger<T>::in_any_order)
      lost_.add(energy);
    else
      cells_[s].lost += energy;
  }
  void lose(const Ledger<T>& elsewhere) { lost_.add(elsewhere); }
  const Ledger<T>& ledger() const { return lost_; }
  T energy_lost(Slot first, Slot last) const {
    if constexpr (Ledger<T>::in_any_order) return lost_.value();
    T sum(0);
    if constexpr (!Ledger<T>::in_any_order)
      for (Slot s = first; s <= last; ++s) sum += cells_[s].lost;
    return sum;
  }

 private:
  using Cells::cells_, Cells::lag_;

  // The time if the gap is closing. Whether it is cannot be predicted, so the choice is by bits: a positive number is
  // a positive integer.
  [[gnu::always_inline]] static double if_closing(double time, double closing) {
    const auto opening = std::uint64_t{0} - (std::bit_cast<std::int64_t>(closing) <= 0);
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(time) & ~opening) |
                                 (std::bit_cast<std::uint64_t>(EventQueue::never) & opening));
  }
  // The largest negative gap that rounding explains, see `note`. Times are rounded in units of the offset, times due
  // before the last move of the origin in units of the offset at that move (`blur_`), and distances in units of the
  // distance. Each error acts on the gap at its speed before or after the collision. A negative gap stays negative and
  // collides late, which shifts its neighbours in proportion to their gains: only the first such gap shows a lost
  // order.
  T below_zero(Slot s, const T& closing, const T& gain, const T& since, const T& struck, const T& time) const {
    const T& gap = cells_[s].gap;
    const T before = is_negative(since) ? T(gap - gain * since) : T(gap + (closing - gain) * since);
    T rounding = rounding_of(magnitude(time) + magnitude(since) + magnitude(struck));
    if (time < blur_) rounding += blur_;
    T most = (magnitude(closing) + magnitude(gain)) * rounding;
    if (is_negative(before)) most -= before;
    if (is_negative(struck)) most -= gain * struck;
    return most;
  }
  static T rounding_of(const T& time) { return T(16) * T(std::numeric_limits<T>::epsilon()) * time; }

  // A queue time, replaced if rounding has made it infinite, which would be `never`.
  [[gnu::always_inline]] double in_range(double rounded, Slot s, const T& closing) const {
    return std::isfinite(rounded) ? rounded : queue_due(s, closing);
  }

  // Queue times are local times in units of 2^-shift, with the next collision within the range of double.
  template <class EachHeld> void choose_shift(const EachHeld& each_held) {
    long least = std::numeric_limits<long>::max();
    each_held([&](Slot s, const T& closing) {
      if (!is_positive(closing)) return;
      const T next = collision_time(s, closing);
      long exponent = 0;
      if (split(next, exponent) > 0) least = std::min(least, exponent);
    });
    shift_ = least < -500 || (least > 500 && least < std::numeric_limits<long>::max()) ? -least : 0;
  }

  Clock<T> clock_;
  T floor_{0};
  T blur_{0};       // rounding of times at the last move of the origin: collisions due then may be late by it
  long shift_ = 0;  // of queue times, see choose_shift(); stays 0 in types of the range of double
  Account<T> account_;
  Ledger<T> lost_;
};

}  // namespace cradle
