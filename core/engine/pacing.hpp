#pragma once
// How often the event loop reviews what is not a collision, and when the origin of time moves. Both follow from the
// history of collisions alone, not from the calls of `advance`.
//
// A small zone is reviewed by numbers of collisions. A move of the origin costs as much as a few collisions per gap: it
// comes with every second collision in a few-particle collapse and after some 32 collisions per particle otherwise.
//
// In a large zone time is divided into epochs: the time of the next move of the origin is known since the last move, so
// that collisions far apart need no common order for it (segments.hpp). An epoch lasts as long as some 8 collisions per
// active particle should take, or 32 where particles merge, by the rate of the epoch before. It ends early, with the
// collision after which the chain requests that: where the flight before it was too short for the time since the
// origin, or where there are four times as many collisions per particle as it should have.

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "cradle/core/chains/notice.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct Pacing {
  Pacing(const T& start, bool may_collapse)
      : time_before(start), may_collapse_(may_collapse), per_particle_(may_collapse ? 8 : 32) {}

  static constexpr std::uint64_t large = 512;  // active particles from which on there are epochs

  std::uint64_t next_review = 1;         // collisions made when the next regular review is due
  std::uint64_t collisions_at_move = 0;  // collisions made when the origin moved last
  std::uint64_t collisions_before = 0;  // collisions made, and the local time, at the regular review or the move before
  T time_before;

  bool in_epochs = false;
  T epoch{0};                         // how long this one is to last, from time_before
  T epoch_end{0};                     // local
  std::uint64_t expected = 0;         // collisions in it
  std::uint64_t next_poll = 0;        // collisions made when the caller is polled again
  std::uint64_t most_collisions = 0;  // made in all when it ends at the latest

  // After a collision at the given local time, with so many particles active. The chain may request a move; at a
  // regular review the origin moves if particles can collapse. If they merge instead, the origin moves only after many
  // collisions, or where these come at more than twice the rate, since the review before, that they have had since the
  // last move.
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

  // After a review at the local time `then`, which is called `now` since. Reviews that a chain requested
  // (Notice::needs_slots) change nothing: they depend on what is streamed.
  void reviewed(std::uint64_t collisions, const T& then, const T& now, std::uint64_t active, bool moved) {
    const bool regular = collisions >= next_review;
    if (moved && active >= large && (in_epochs ? collisions >= most_collisions : regular))
      foresee(T(then - time_before), collisions - collisions_before, active);
    if (moved) collisions_at_move = collisions;
    if (in_epochs) {
      if (moved) begin_epoch(collisions, now, active);
      return passed(collisions, active);
    }
    if (!moved && !regular) return;
    begin_reviews(collisions, now, active);
  }
  // Collisions to come up to a time in this epoch: by the rate foreseen, or by that so far. 0: no epochs.
  double ahead(std::uint64_t collisions, const T& now, const T& until) const {
    if (!in_epochs) return 0;
    const double made = static_cast<double>(collisions - collisions_before);
    const double passed = to_double(T((now - time_before) / epoch)), left = to_double(T((until - now) / epoch));
    return left * std::max(static_cast<double>(expected), passed > 0 ? made / passed : 0);
  }
  // After so many more collisions this epoch ends.
  std::uint64_t left(std::uint64_t collisions) const {
    return collisions < most_collisions ? most_collisions - collisions : 0;
  }
  // After so many collisions without any review. They are fewer than an epoch's most.
  void passed(std::uint64_t collisions, std::uint64_t active) {
    if (collisions >= next_poll) next_poll = collisions + std::min<std::uint64_t>(32 * active, 1 << 20);
    next_review = std::min(most_collisions, next_poll);
  }
  // The origin has moved to where the epoch ends, which is called `now` since.
  void epoch_ended(std::uint64_t collisions, const T& now, std::uint64_t active) {
    foresee(epoch, collisions - collisions_before, active);
    collisions_at_move = collisions;
    if (!in_epochs) return begin_reviews(collisions, now, active);
    begin_epoch(collisions, now, active);
    passed(collisions, active);
  }

  // Whether it can be that of a run of so many particles which has made so many collisions, the last one at the given
  // local time and so long after the start, but for rounding. Who waits for a review too long could not be interrupted.
  bool follows(std::uint64_t collisions, const T& last_collision, const T& since_start, std::int64_t particles) const {
    constexpr std::uint64_t most = std::uint64_t{1} << 50;  // in a year; 4096 times as many are an integer too
    return collisions < most && collisions_before <= collisions && collisions_at_move <= collisions &&
           expected < most &&
           std::max({next_review, next_poll, most_collisions}) <=
               collisions + 4 * per_particle_ * static_cast<std::uint64_t>(particles) + 16 &&
           is_finite(since_start) && since_start > T(-1) && is_finite(last_collision) && is_finite(time_before) &&
           is_finite(epoch) && is_finite(epoch_end) &&
           (!in_epochs || (is_positive(epoch) && !(epoch_end < last_collision)));
  }
  static auto state(auto& self) {
    return std::tie(self.next_review, self.collisions_at_move, self.collisions_before, self.time_before, self.in_epochs,
                    self.epoch, self.epoch_end, self.expected, self.next_poll, self.most_collisions);
  }

 private:
  // How long the next epoch is to be where so many collisions have taken so long: as long as those that it is to have
  // should take, but not too many times as long, since a rate is not known well from a few collisions.
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

}  // namespace cradle
