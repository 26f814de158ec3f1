#pragma once
// The gap between any wall and a particle: the wall is shaken (shaken_approach.hpp) or not (approach.hpp), and may hold
// particles that are slower than its rest speed. Such a particle has no gap and no closing speed. It moves with the
// wall for as long as the wall presses it, p + s'' > 0; then it is let go, at the speed of the wall: at a known phase.
//
// To a particle above those that the wall holds they are the wall, until they are let go; from then on both fall.

#include <optional>

#include "cradle/core/laws/shaken_approach.hpp"

namespace cradle {

// What is known of the wall at a gap: its motion, null if it is not shaken; whether it holds particles, and the phase
// at which it lets go of them, if it does.
template <Real T> struct HoldingWall {
  const WallMotion<T>* motion = nullptr;
  bool holds = false;
  std::optional<T> release;

  // The pull that a particle of this pull has on it at a time since the start, and whether the wall presses it then.
  T pressure(const T& pull, const Pair<T>& elapsed) const {
    return motion != nullptr ? T(pull + at(elapsed).wall.acceleration) : pull;
  }
  bool presses(const T& pull, const Pair<T>& elapsed) const { return is_positive(pressure(pull, elapsed)); }
  // A shaken wall at a time since the start. The last answer is kept, since a collision asks several times.
  const WallMoment<T>& at(const Pair<T>& elapsed) const {
    if (!last || !(last->elapsed.high == elapsed.high && last->elapsed.low == elapsed.low))
      last = motion->moment(elapsed);
    return *last;
  }
  mutable std::optional<WallMoment<T>> last = {};
};

template <Real T> class WallApproach {
 public:
  // Arguments as for Approach (approach.hpp); `since` is the time since the start at which the gap has this size. A
  // particle may be one that does not rest although the wall holds particles.
  WallApproach(const T& gap, const T& closing, const T& pull, const T& splitter, const HoldingWall<T>& wall,
               const Pair<T>& since, bool may_rest = true)
      : straight_(gap, closing, pull, splitter), motion_(wall.motion),
        rests_(may_rest && wall.holds && gap == T(0) && closing == T(0) && wall.presses(pull, since)) {
    if (motion_ == nullptr) return;
    if (!rests_)
      shaken_.emplace(gap, closing, pull, splitter, *motion_, wall.at(since));
    else if (wall.release)
      let_go(*wall.release, pull, splitter, wall.at(since));
  }

  // The gap above particles that a wall holds. Until they are let go, the time `held` after `since` (nothing: never),
  // it is the gap to a wall with this motion (null: unshaken) and this pull; from then on its pull is `later`.
  WallApproach(const T& gap, const T& closing, const T& pull, const T& splitter, const WallMotion<T>* motion,
               const Pair<T>& since, const std::optional<T>& held, const T& later)
      : straight_(gap, closing, pull, splitter), motion_(motion), rests_(false) {
    if (motion != nullptr && !(held && motion->jumps()))  // it does not jump while it holds them
      shaken_.emplace(gap, closing, pull, splitter, *motion, motion->moment(since));
    if (!held) return;
    const T until = is_negative(*held) ? T(0) : *held;
    const Pair<T> then = since + until;
    freed_.emplace(Freed{until, {gap_after(until, then), closing_after(until, then), later, splitter}});
  }

  // After a time, which is `now` since the start: the closing speed, its mean until then, and the gap.
  T closing_after(const T& time, const Pair<T>& now) const {
    if (freed_ && freed_->at < time) return freed_->approach.closing_after(T(time - freed_->at));
    if (rests(time, now)) return T(0);
    return shaken_ ? shaken_->after(T(time - released_), now).closing : straight_.closing_after(time);
  }
  T gap_after(const T& time, const Pair<T>& now) const {
    if (freed_ && freed_->at < time) return freed_->approach.gap_after(T(time - freed_->at));
    if (rests(time, now)) return T(0);
    return shaken_ ? shaken_->after(T(time - released_), now).gap : straight_.gap_after(time);
  }
  T mean_closing(const T& time, const Pair<T>& now) const {
    if (!shaken_ && !rests_ && !freed_) return straight_.mean_closing(time);
    return time == T(0) ? closing_after(time, now) : T((straight_.gap_after(T(0)) - gap_after(time, now)) / time);
  }
  // The rate at which the closing speed grows then.
  T acceleration_after(const T& time, const Pair<T>& now) const {
    if (freed_ && freed_->at < time) return freed_->approach.pull();
    if (rests(time, now)) return T(0);
    return motion_ != nullptr ? T(straight_.pull() + motion_->moment(now).wall.acceleration) : straight_.pull();
  }
  // The next collision, as in approach.hpp.
  std::optional<WallMeeting<T>> meeting() const {
    const std::optional<WallMeeting<T>> held = held_meeting();
    if (!freed_ || (held && !(freed_->at < held->in))) return held;
    const auto free = freed_->approach.meeting();
    return free ? std::optional<WallMeeting<T>>({T(freed_->at + free->in), free->speed}) : std::nullopt;
  }
  // How long the particle has rested after a time.
  T rested(const T& time, const Pair<T>& now) const { return !rests_ ? T(0) : rests(time, now) ? time : released_; }
  // After what time it is let go, 0 if it does not rest; nothing: never.
  std::optional<T> let_go_in() const {
    if (rests_ && !shaken_) return {};
    return rests_ ? released_ : T(0);
  }

 private:
  std::optional<WallMeeting<T>> held_meeting() const {
    if (!shaken_) return rests_ ? std::nullopt : straight_.meeting();
    const auto meeting = shaken_->meeting();
    return meeting ? std::optional<WallMeeting<T>>({T(released_ + meeting->in), meeting->speed}) : std::nullopt;
  }

  bool rests(const T& time, const Pair<T>& now) const {
    if (!rests_ || !shaken_) return rests_;
    return motion_->jumps() ? motion_->at(now).whole < tooth_ : !(released_ < time);
  }
  // Rests until the phase `at`. The sine does not press it again before the phase 1/2 - at.
  void let_go(const T& at, const T& pull, const T& splitter, const WallMoment<T>& now) {
    const Phase<T>& phase = now.phase;
    T turns = at - phase.rest;
    if (is_negative(turns)) turns = phase.rest < T(1) / T(2) - at ? T(0) : T(turns + T(1));
    released_ = turns * motion_->period();
    tooth_ = phase.whole + T(1);
    const bool jumps = motion_->jumps();
    const Phase<T> free{jumps ? tooth_ : phase.whole, jumps ? T(T(-1) / T(2)) : at};
    const T open = motion_->shape() == Shape::sine ? T((T(1) / T(2) - (at + at)) * motion_->period()) : T(0);
    const Pair<T> then = now.elapsed + released_;
    shaken_.emplace(jumps ? T(motion_->amplitude() + motion_->amplitude()) : T(0), T(0), pull, splitter, *motion_,
                    WallMoment<T>{then, motion_->turns_at(then), free, motion_->at_phase(free.rest)}, open);
  }

  Approach<T> straight_;
  const WallMotion<T>* motion_;
  std::optional<ShakenApproach<T>> shaken_;  // of a particle that rests: after it is let go
  bool rests_;
  T released_{0}, tooth_{0};
  struct Freed {
    T at;
    Approach<T> approach;
  };
  std::optional<Freed> freed_;  // of a gap above particles that are let go: then
};

}  // namespace cradle
