#pragma once
// `Pacing` decides how often the event loop does work other than collisions, and when the origin of time moves, by the
// history of collisions alone: README.md (When the origin of time moves) says what for.
//
// In a small zone of n active particles regular reviews come after n^2/8 + 1 collisions, or after 32 n + 16 if these
// are fewer (from 257 particles on). If particles can collapse, the origin moves at each of them.
//
// In a large zone time is divided into epochs. An epoch lasts for about 8 collisions per active particle, or 32 if
// particles merge, estimated from the rate of the previous epoch. It ends early after a collision at which the chain
// says that the origin must move, or after four times as many collisions per particle as it was made for.

#include <algorithm>
#include <cstdint>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/chain.hpp"

namespace cradle {

template <Real T> struct Pacing {
  Pacing(const T& start, bool may_collapse)
      : time_before(start), may_collapse_(may_collapse), per_particle_(may_collapse ? 8 : 32) {}

  static constexpr std::uint64_t large = 512;  // active particles; epochs begin at this number

  std::uint64_t next_review = 1;         // number of collisions at the next regular review
  std::uint64_t collisions_at_move = 0;  // number of collisions when the origin moved last
  // Number of collisions and local time at the previous regular review or move.
  std::uint64_t collisions_before = 0;
  T time_before;

  bool in_epochs = false;
  T epoch{0};                         // length of the present epoch, from time_before
  T epoch_end{0};                     // local
  std::uint64_t expected = 0;         // collisions in the epoch
  std::uint64_t next_poll = 0;        // number of collisions at which the caller is polled again
  std::uint64_t most_collisions = 0;  // number of collisions at which the epoch ends at the latest

  // Decides after a collision at the given local time, with so many active particles. The chain may request a move. At
  // a regular review the origin moves if particles can collapse or the zone is large (epochs then begin), otherwise
  // only after many collisions, or if their rate since the last review is more than twice that since the last move.
  bool origin_moves(Notice notice, std::uint64_t collisions, const T& time, std::uint64_t active) const {
    const std::uint64_t since_move = collisions - collisions_at_move;
    if (includes(notice, Notice::origin_must_move)) return true;
    if (in_epochs) return collisions >= most_collisions;
    if (includes(notice, Notice::origin_should_move) && 16 * since_move >= active) return true;
    if (collisions < next_review) return false;
    if (may_collapse_ || active >= large || since_move >= 32 * active + 16) return true;
    return T(static_cast<std::int64_t>(2 * since_move)) * (time - time_before) <
           T(static_cast<std::int64_t>(collisions - collisions_before)) * time;
  }

  // After a review at the local time `then`, which is now called `now`. Reviews that a chain requested
  // (Notice::needs_slots) change nothing: they depend on what is streamed.
  void reviewed(std::uint64_t collisions, const T& then, const T& now, std::uint64_t active, bool moved) {
    const bool regular = collisions >= next_review;
    if (moved && active >= large && (in_epochs ? collisions >= most_collisions : regular))
      foresee(T(then - time_before), collisions - collisions_before, active);
    if (moved) collisions_at_move = collisions;
    if (in_epochs) {
      if (moved) begin_epoch(collisions, now, active);
      return set_next_review(collisions, active);
    }
    if (!moved && !regular) return;
    begin_reviews(collisions, now, active);
  }
  // Collisions expected up to a time in this epoch: by the predicted rate, or by that until now. 0: no epochs.
  double ahead(std::uint64_t collisions, const T& now, const T& until) const {
    if (!in_epochs) return 0;
    const double made = static_cast<double>(collisions - collisions_before);
    const double passed = to_double(T((now - time_before) / epoch)), left = to_double(T((until - now) / epoch));
    return left * std::max(static_cast<double>(expected), passed > 0 ? made / passed : 0);
  }
  // The number of collisions after which this epoch ends.
  std::uint64_t left(std::uint64_t collisions) const {
    return collisions < most_collisions ? most_collisions - collisions : 0;
  }
  // In an epoch, after so many collisions (fewer than it may have): sets the next review and when the caller is polled.
  void set_next_review(std::uint64_t collisions, std::uint64_t active) {
    if (!in_epochs) return;
    if (collisions >= next_poll) next_poll = collisions + std::min<std::uint64_t>(32 * active, 1 << 20);
    next_review = std::min(most_collisions, next_poll);
  }
  // The origin has moved to the end of the epoch, which is now called `now`.
  void epoch_ended(std::uint64_t collisions, const T& now, std::uint64_t active) {
    foresee(epoch, collisions - collisions_before, active);
    collisions_at_move = collisions;
    in_epochs ? begin_epoch(collisions, now, active) : begin_reviews(collisions, now, active);
    set_next_review(collisions, active);
  }

  // Whether it can be the pacing of a run with so many particles and collisions, the last one at the given local time
  // and time since the start, up to rounding. If the next review were too far ahead, the run could not be interrupted.
  bool follows(std::uint64_t collisions, const T& last_collision, const T& since_start, std::int64_t particles) const {
    constexpr std::uint64_t most = std::uint64_t{1} << 50;  // more than in a year; 4096 times this fits 64 bits
    return collisions < most && collisions_before <= collisions && collisions_at_move <= collisions &&
           expected < most &&
           std::max({next_review, next_poll, most_collisions}) <=
               collisions + 4 * per_particle_ * static_cast<std::uint64_t>(particles) + 16 &&
           is_finite(since_start) && since_start > T(-1) && is_finite(last_collision) && is_finite(time_before) &&
           is_finite(epoch) && is_finite(epoch_end) &&
           (!in_epochs || (is_positive(epoch) && !(epoch_end < last_collision)));
  }
  static auto state(auto& self) {
    return fields(self.next_review, self.collisions_at_move, self.collisions_before, self.time_before, self.in_epochs,
                  self.epoch, self.epoch_end, self.expected, self.next_poll, self.most_collisions);
  }

 private:
  // Sets the length of the next epoch if so many collisions have taken so long: the time expected for its collisions,
  // but limited, since a few collisions do not give a reliable rate. Without a positive length there is no epoch.
  void foresee(const T& took, std::uint64_t collisions, std::uint64_t active) {
    const auto aim = static_cast<std::int64_t>(per_particle_ * active), made = static_cast<std::int64_t>(collisions);
    const std::int64_t most = made < 64 ? 64 : 4096;
    T next = aim > most * made ? T(took * T(most)) : T(took * T(aim) / T(made));
    if (!is_positive(next)) next = epoch / T(64);  // no time has passed
    in_epochs = is_positive(next);
    epoch = next;
    expected = static_cast<std::uint64_t>(std::min(most * std::max<std::int64_t>(made, 1), aim));
  }
  void begin_reviews(std::uint64_t collisions, const T& now, std::uint64_t active) {
    collisions_before = collisions;
    time_before = now;
    next_review = collisions + std::min(32 * active + 16, active * active / 8 + 1);
  }
  void begin_epoch(std::uint64_t collisions, const T& now, std::uint64_t active) {
    collisions_before = collisions;
    time_before = now;
    epoch_end = now + epoch;
    most_collisions = collisions + 4 * per_particle_ * active + 16;
  }

  bool may_collapse_;
  std::uint64_t per_particle_;  // collisions in an epoch
};

// `Standstill` detects that time does not advance. Many particles may meet at one time and place: n(n - 1)/2 collisions
// if they are elastic. README.md (When a type resolves no more) has the two bounds on collisions at one time, local and
// since the start, and says why the run ends beyond them.
//
// The second one allows for a collapse that a cut-off ends, or a gap at which the run is to stop. n particles can
// collapse only if 1 - eps is at least about pi/n: then their speeds fall by a factor exp(x) within n^2 x/pi
// collisions, and the bound allows for a factor of 10^5000, or for that of the smallest gap to the one at which the run
// stops, if it is more.
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
    return fields(self.time, self.elapsed, self.collisions_then, self.collisions_at_elapsed);
  }

  // Whether time stands still; asked at a review, with local time, time since the start, collisions made and active
  // particles. `shrinks` says that the last collision was with a floor, and that the run stops when a rebound from it
  // is small enough: absolute times do not resolve rebounds, but their heights are known.
  bool at(const T& now, const T& since_start, std::uint64_t collisions, std::uint64_t active, bool shrinks = false) {
    if (now > time) collisions_then = collisions;
    if (since_start > elapsed) elapsed = since_start, collisions_at_elapsed = collisions;
    const std::uint64_t larger_bound = (1 << 20) + 4096 * active * active;
    return collisions - collisions_then > (threshold_ || shrinks ? larger_bound : 64 + 4 * active * active) ||
           collisions - collisions_at_elapsed > times_ * larger_bound;
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
