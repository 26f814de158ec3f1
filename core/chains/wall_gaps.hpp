#pragma once
// `WallGaps` makes what happens at the gaps to walls, and at the gap above a pile, under gravity (gravity.hpp) or where
// a wall is shaken: those gaps of a line (gap_line.hpp) are curves in time. Nothing here is on the hot path.

#include <array>

#include "cradle/core/chains/gap_line.hpp"
#include "cradle/core/chains/gravity.hpp"

namespace cradle {

template <class Line> class WallGaps : public Gravity<typename Line::Scalar> {
  using T = typename Line::Scalar;
  using Field = Gravity<T>;

 public:
  using Field::approach, Field::anywhere, Field::pulls, Field::at_wall, Field::may_miss, Field::above_pile;
  using Field::approach_pile, Field::rebound, Field::height, Field::pile_end, Field::resting, Field::rest;
  using Field::Field;

  // Calls f with the motion of the gaps of a line, some of which may be pulled or not.
  template <class F> decltype(auto) with_motion(const Line& line, F f) const {
    return anywhere() ? f(Curved{line, *this}) : f(typename Line::Straight{line.gaps});
  }

  WallApproach<T> approach(const Line& line, Slot s) const {
    return approach(line, s, line.gaps[s].gap, line.closing(s));
  }
  // The approach that the gap would have with this size and this closing speed.
  WallApproach<T> approach(const Line& line, Slot s, const T& gap, const T& closing) const {
    if (above_pile(line.particle(s))) {
      const std::optional<T> free = pile_let_go(line, s);
      return approach_pile(gap, closing, line.gaps.since_start(s),
                           free ? std::optional<T>(line.gaps.flown(s, *free)) : std::nullopt);
    }
    return approach(line.particle(s), gap, closing, line.gaps.since_start(s));
  }
  // The local time at which the wall lets go of a pile, which has the gap s above it or in it; nothing: never.
  std::optional<T> pile_let_go(const Line& line, Slot s) const {
    const auto below = static_cast<Slot>(height(line.particle(s)));
    const Slot lowest = pile_end() == End::left ? s - below : s + below;
    const std::optional<T> wait = approach(line, lowest).let_go_in();
    return wait ? std::optional<T>(line.gaps.after(lowest, *wait)) : std::nullopt;
  }
  T gap_at(const Line& line, Slot s, const T& time) const {
    return approach(line, s).gap_after(line.gaps.flown(s, time), line.gaps.clock().since_start(time));
  }
  T closing_at(const Line& line, Slot s, const T& time) const {
    return approach(line, s).closing_after(line.gaps.flown(s, time), line.gaps.clock().since_start(time));
  }
  // The next collision there; nothing if there is none. At a wall the last answer is kept: it is asked for again when
  // the collision is made, and when the origin of time has moved.
  std::optional<WallMeeting<T>> meeting(const Line& line, Slot s) const {
    if (above_pile(line.particle(s))) return approach(line, s).meeting();
    const T &gap = line.gaps[s].gap, &closing = line.closing(s);
    const Pair<T> since = line.gaps.since_start(s);
    auto& last = last_[line.particle(s) < 0 ? 0 : 1];
    if (!last || !(last->gap == gap && last->closing == closing && last->since.high == since.high &&
                   last->since.low == since.low && last->resting == resting()))
      last = {gap, closing, since, resting(), approach(line.particle(s), gap, closing, since).meeting()};
    return last->meeting;
  }
  // The local time of the next collision at any gap (far away: never), the same as queue time, and how fast it is.
  T due(const Line& line, Slot s) const {
    if constexpr (!Line::Gaps::keys_are_exact)
      if (pulls(line.particle(s))) return pulled_due(line, s).value_or(far_away<T>());
    return line.due(s);
  }
  double queue_due(const Line& line, Slot s) const {
    if constexpr (!Line::Gaps::keys_are_exact)
      if (pulls(line.particle(s))) return pulled_queue_due(line, s);
    return line.queue_due(s);
  }
  T closing_when_due(const Line& line, Slot s) const {
    if (!pulls(line.particle(s))) return line.closing(s);
    const auto next = meeting(line, s);
    return next ? next->speed : T(0);
  }
  // The queue time of the next collision at a gap that is pulled.
  double pulled_queue_due(const Line& line, Slot s) const {
    const std::optional<T> time = pulled_due(line, s);
    return time ? line.gaps.queue_time(*time) : EventQueue::never;
  }
  // The same, and enters it where keys are stored.
  double foresee(Line& line, Slot s) {
    const double time = pulled_queue_due(line, s);
    if constexpr (Line::Gaps::keys_are_exact) line.gaps[s].due = time;
    return time;
  }
  // The effect of a collision at a wall or beside the gap to one, off the hot path. `pile` particles are in the pile
  // after it; one that comes to rest on others does not move them. `renew` is called while the pile is as it was.
  template <class Renew>
  CollisionResult<T> strike(Line& line, Slot p, Slot s, Slot n, const T& time, const Outcome<T>& outcome, Notice notice,
                            ParticleIndex pile, const Renew& renew) {
    const T since = line.gaps.flown(s, time);
    notice |= of_flight(line.gaps.queue_time(since), line.gaps.queue_time(time));
    const bool with_wall = at_wall(line.particle(s)), lands = pile > resting() && resting() > 0;
    const bool to_left = !lands || pile_end() == End::right, to_right = !lands || pile_end() == End::left;
    if constexpr (Line::watched) {
      line.certainty.collision(line.gaps, Curved{line, *this}, p, s, n, line.particle(s), time,
                               closing_when_due(line, s), outcome, line.masses.of_pair(s), line.exact_sums(),
                               {to_left, to_right});
    }
    if (to_left) notice |= kick(line, p, outcome.to_left, since, time);
    if (to_right) notice |= kick(line, n, outcome.to_right, since, time);
    notice |= renew();
    line.gaps.close(s, outcome.closing, since, time);
    line.gaps[s].closing = outcome.closing;
    line.gaps.forget(s);
    rest(pile);
    if (with_wall && is_negative(since)) {  // late: it has fallen since then
      const WallApproach<T> open =
          approach(line.particle(s), T(0), outcome.closing, line.gaps.clock().since_start(time));
      line.gaps[s].gap = open.gap_after(T(-since), line.gaps.since_start(s));
      line.gaps[s].closing = open.closing_after(T(-since), line.gaps.since_start(s));
    }
    const auto predict = [&](Slot beside) {
      if (!pulls(line.particle(beside))) return line.gaps.predict(beside, line.closing(beside));
      if constexpr (Line::watched) watch_meeting(line, beside, time);
      return foresee(line, beside);
    };
    if constexpr (Line::watched)
      if (with_wall) watch_meeting(line, s, time);
    if (const auto back = rebound(line.particle(s), line.closing(s), line.gaps.since_start(s));
        back && back->height < line.gaps.floor())
      notice |= Notice::gap_below_floor;
    return {outcome, predict(p), with_wall ? foresee(line, s) : EventQueue::never, predict(n), notice, p, n};
  }

  // Brings a gap that is pulled to a time at which nothing happens to it.
  Notice renew(Line& line, Slot s, const T& time) {
    if constexpr (Line::watched) line.certainty.renew(line.gaps, Curved{line, *this}, s, time);
    return kick(line, s, T(0), T(0), time);
  }

  // Whether rounding decides that a pulled gap meets its wall, or at which of two times. A floor at rest is always met.
  // A particle that the wall has just stopped has its speed whatever the time: rounding moves only that time.
  void watch_meeting(Line& line, Slot s, const T& time) {
    if (!may_miss(line.particle(s))) return;
    const T &gap = line.gaps[s].gap, &closing = line.closing(s);
    const Pair<T> since = line.gaps.since_start(s);
    T acceleration(0);
    if (gap == T(0) && closing == T(0) && !above_pile(line.particle(s)))
      acceleration = approach(line, s).acceleration_after(T(0), since);
    line.certainty.meeting(line.gaps, s, line.particle(s), time, [&](const T& less, const T& faster) {
      if (acceleration == T(0)) return approach(line, s, T(gap - less), T(closing + faster)).meeting();
      const T later = T(-faster / acceleration);
      auto met = approach(line.particle(s), gap, closing, since + later).meeting();
      if (met) met->in += later;
      return met;
    });
  }

 private:
  std::optional<T> pulled_due(const Line& line, Slot s) const {
    const auto next = meeting(line, s);
    return next ? std::optional<T>(line.gaps.after(s, next->in)) : std::nullopt;
  }

  // How gaps move where some of them are pulled.
  struct Curved {
    static constexpr bool curved = true;
    const Line& line;
    const WallGaps& walls;
    GapMotion<T> operator()(Slot s, const T& time) const {
      if (!walls.pulls(line.particle(s))) return typename Line::Straight{line.gaps}(s, time);
      const WallApproach<T> open = walls.approach(line, s);
      const T since = line.gaps.flown(s, time);
      const Pair<T> now = line.gaps.clock().since_start(time);
      return {since, open.gap_after(since, now), open.closing_after(since, now), open.acceleration_after(since, now)};
    }
    GapMotion<T> at_local_time(Slot s) const {
      const auto& own = line.gaps[s];
      if (!walls.pulls(line.particle(s))) return {T(0), own.gap, own.closing};
      return {T(0), own.gap, own.closing, walls.approach(line, s).acceleration_after(T(0), line.gaps.since_start(s))};
    }
  };

  // GapLine::kick at any gap.
  Notice kick(Line& line, Slot s, const T& gain, const T& struck, const T& time) {
    if (!pulls(line.particle(s))) {
      if constexpr (Line::watched)
        return line.kick(s, Pair<T>{gain, T(0)}, struck, time);
      else
        return line.kick(s, gain, struck, time);
    }
    const T flown = line.gaps.flown(s, time);
    const WallApproach<T> open = approach(line, s);
    const Pair<T> at = line.gaps.clock().since_start(time);
    const bool late = is_negative(flown);
    const T mean = late ? line.closing(s) : open.mean_closing(flown, at),
            now = late ? line.closing(s) : open.closing_after(flown, at);
    const T since = line.gaps.kick(
        s, mean, [&]() -> const T& { return gain; }, time);
    line.gaps[s].closing = now + gain;
    if (line.gaps.below_floor(s)) return line.gaps.note(s, T(mean + gain), gain, since, struck, line.particle(s), time);
    return Notice::none;
  }

  struct Answer {
    T gap, closing;
    Pair<T> since;
    ParticleIndex resting;
    std::optional<WallMeeting<T>> meeting;
  };
  mutable std::array<std::optional<Answer>, 2> last_{};  // at the left wall and at the right one
};

}  // namespace cradle
