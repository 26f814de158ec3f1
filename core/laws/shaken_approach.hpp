#pragma once
// The gap between a shaken wall (wall_motion.hpp) and a particle with a constant acceleration: with s(t) the place of
// the wall on its path, w the closing speed at the time 0, p the pull (approach.hpp),
//
//   g(t) = g - w t - p t^2/2 - (s(t) - s(0) - s'(0) t),   w(t) = w + p t + s'(t) - s'(0).
//
// The time at which it closes is found as follows, and no collision is passed by:
//
//   sawtooth   on the k-th tooth the gap is that to a wall that never jumps, + 2 k A: a quadratic equation for each
//              tooth, one after the other
//   parabola   a quadratic equation for each arc, one after the other
//   sine       w cannot grow faster than p + A omega^2, nor within a time d faster than p + s'' + A omega^3 d. So the
//              gap stays open for as long as one that closes at that rate; such waits are made one after the other.
//              Once w surely stays positive, there is one root, and the series of g to the fourth order says where, but
//              for its rest, which is below A omega^5 d^5/120: the search goes to where the gap is surely still open,
//              or ends if the rest cannot show. At a double root waits shrink by a constant factor each.
//
// While the wall cannot reach the particle, since it is further than A from the wall's place, time is skipped. There is
// no collision if none comes within a period after the particle has ceased to approach that place.
// A gap that touches 0 or falls below it by rounding alone, and opens again, does not close. On the sawtooth, a
// particle that is at the tip at the time of the jump, but for rounding, is not hit.
// The search ends: a time so long that the type does not resolve arcs or teeth counts as that of the collision.

#include <algorithm>
#include <limits>
#include <optional>

#include "cradle/core/laws/approach.hpp"
#include "cradle/core/laws/wall_motion.hpp"

namespace cradle {

template <Real T> class ShakenApproach {
 public:
  struct State {
    T gap, closing;
  };

  // As an Approach, with the motion of the wall and its moment now. `open`: how long the gap surely does not close.
  ShakenApproach(const T& gap, const T& closing, const T& pull, const T& splitter, const WallMotion<T>& motion,
                 const WallMoment<T>& now, const T& open = T(0))
      : gap_(gap), closing_(closing), pull_(pull), splitter_(splitter), motion_(motion), since_(now.elapsed),
        turns_(now.turns), phase_(now.phase), place_(now.wall.place), speed_(now.wall.speed), open_(open) {}

  // After a time; `now` is then the time since the start.
  State after(const T& time, const Pair<T>& now) const {
    switch (motion_.shape()) {
    case Shape::sawtooth: {
      const Approach<T> along = straight(gap_, closing_, pull_);
      const T jumps = motion_.at(now).whole - phase_.whole;
      return {T(along.gap_after(time) + (motion_.amplitude() + motion_.amplitude()) * jumps),
              along.closing_after(time)};
    }
    case Shape::parabola:
      return on_arcs(time, now);
    case Shape::sine:
      break;
    }
    return on_sine(time, [&] { return motion_.at(now).rest; }).state;
  }

  // The next collision; nothing if there is none.
  std::optional<WallMeeting<T>> meeting() const {
    switch (motion_.shape()) {
    case Shape::sawtooth:
      return on_teeth();
    case Shape::parabola:
      return on_arcs();
    case Shape::sine:
      break;
    }
    return on_sine();
  }

 private:
  Approach<T> straight(const T& gap, const T& closing, const T& pull) const { return {gap, closing, pull, splitter_}; }
  static T whole_below(const T& x) { return nearest_whole(T(x - T(1) / T(2))); }

  // For long times: the wall may be anywhere on its path. The distance from its place, which the particle approaches at
  // the speed w - s'(0), does not lose digits.
  State with_wall(const Displaced<T>& wall, const T& time) const {
    const Approach<T> to_place = straight(T(gap_ + (place_ - wall.place)), T(closing_ - speed_), pull_);
    return {to_place.gap_after(time), T(to_place.closing_after(time) + wall.speed)};
  }

  // How long the wall will not reach a particle at this distance from its place, with a sixteenth of a period to spare;
  // nothing if it never will.
  std::optional<T> out_of_reach(const T& distance, const T& closing) const {
    if (!(motion_.amplitude() < distance)) return T(0);
    const auto wait = straight(T(distance - motion_.amplitude()), closing, pull_).roughly_in();
    if (!wait) return {};
    const T surely = *wait - motion_.period() / T(16);
    return is_positive(surely) ? surely : T(0);
  }
  // A time without collisions after which there are none.
  T last_chance() const {
    const T towards = closing_ - speed_;
    if (is_positive(pull_) || (pull_ == T(0) && is_positive(towards))) return far_away<T>();
    const T turns_back = is_positive(towards) ? T(towards / -pull_) : T(0);
    return turns_back + T(17) * motion_.period() / T(16);
  }

  std::optional<WallMeeting<T>> on_teeth() const {
    const T height = motion_.amplitude() + motion_.amplitude(), never = last_chance();
    const auto first = out_of_reach(T(gap_ + place_), T(closing_ - speed_));
    if (!first) return {};
    for (T teeth = nearest_whole(T(phase_.rest + motion_.at_turns_of(*first)));;) {
      const T jump = (T(1) / T(2) - phase_.rest + teeth) * motion_.period();
      const Approach<T> tooth = straight(T(gap_ + height * teeth), closing_, pull_);
      const auto wait = tooth.meeting();
      if (!wait) return {};
      T rounding = roundings(T(magnitude(since_.high) + jump));
      const bool resolved = rounding < motion_.period() / T(8);
      if (!resolved) rounding = T(0);
      if (wait->in < jump - rounding) return wait;
      if (never < jump) return {};
      const Approach<T> to_place = straight(T(gap_ + place_), T(closing_ - speed_), pull_);
      const T distance = to_place.gap_after(jump);
      if (!resolved && !(motion_.amplitude() < distance)) return unresolved(jump, tooth.closing_after(jump));
      const T unseen = (rounding + rounding) * motion_.fastest();  // so far below the tip it is surely hit
      const auto free = out_of_reach(T(distance + unseen), to_place.closing_after(jump));
      if (!free) return {};
      const T next = teeth + T(1), later = nearest_whole(T(phase_.rest + motion_.at_turns_of(T(jump + *free))));
      if (!(teeth < next)) return unresolved(jump, tooth.closing_after(jump));
      teeth = next < later ? later : next;
    }
  }
  static T roundings(const T& time) { return T(16) * T(std::numeric_limits<T>::epsilon()) * time; }
  static WallMeeting<T> unresolved(const T& time, const T& closing) {
    return {time, is_positive(closing) ? closing : T(0)};
  }

  // An arc that begins `time` later, with so much of it left.
  struct Arc {
    T time, left;
    State state;
    bool upper;  // where the wall is further than its place
  };
  Arc this_arc() const {
    const bool upper = !is_negative(phase_.rest);
    const T turns = upper ? T(T(1) / T(2) - phase_.rest) : T(-phase_.rest);
    return {T(0), T(turns * motion_.period()), {gap_, closing_}, upper};
  }
  Approach<T> on(const Arc& arc) const {
    return straight(arc.state.gap, arc.state.closing,
                    arc.upper ? T(pull_ - motion_.curving()) : T(pull_ + motion_.curving()));
  }
  Arc next(const Arc& arc) const {
    const Approach<T> here = on(arc);
    return {T(arc.time + arc.left),
            T(motion_.period() / T(2)),
            {here.gap_after(arc.left), here.closing_after(arc.left)},
            !arc.upper};
  }
  State on_arcs(const T& time, const Pair<T>& now) const {
    Arc arc = this_arc();
    for (int k = 0; k < 3; ++k, arc = next(arc))
      if (!(arc.time + arc.left < time)) {
        const Approach<T> here = on(arc);
        return {here.gap_after(T(time - arc.time)), here.closing_after(T(time - arc.time))};
      }
    return with_wall(motion_.moment(now).wall, time);
  }
  std::optional<WallMeeting<T>> on_arcs() const {
    const T never = last_chance(), half = motion_.period() / T(2);
    const auto speed_at_start = [&](bool upper) { return upper ? motion_.fastest() : T(-motion_.fastest()); };
    Arc arc = this_arc();
    for (bool first = true;; first = false) {
      const Approach<T> to_place = straight(T(first ? T(arc.state.gap + place_) : arc.state.gap),
                                            T(arc.state.closing - (first ? speed_ : speed_at_start(arc.upper))), pull_);
      const auto free = out_of_reach(to_place.gap_after(T(0)), to_place.closing_after(T(0)));
      if (!free) return {};
      if (half / T(4) < roundings(arc.time) && !(motion_.amplitude() < to_place.gap_after(T(0))))
        return unresolved(arc.time, arc.state.closing);
      if (arc.left < *free) {
        const T more = whole_below(T((*free - arc.left) / half)), until = arc.left + more * half;
        const bool even = nearest_whole(T(more / T(2))) * T(2) == more;
        const T now = arc.time;
        arc = {T(now + until),
               half,
               {to_place.gap_after(until), to_place.closing_after(until)},
               even ? !arc.upper : arc.upper};
        arc.state.closing += speed_at_start(arc.upper);
        if (!(now < arc.time)) return unresolved(now, arc.state.closing);
        continue;
      }
      const Approach<T> here = on(arc);
      const auto wait = here.meeting();
      if (wait && !(arc.left < wait->in)) return WallMeeting<T>{T(arc.time + wait->in), wait->speed};
      const T now = arc.time;
      arc = next(arc);
      if (never < arc.time) return {};
      if (!(now < arc.time)) return unresolved(now, arc.state.closing);
    }
  }

  struct OnSine {
    State state;
    T place, speed;  // of the wall
  };
  // `phase` gives that after the time.
  template <class GetPhase> OnSine on_sine(const T& time, const GetPhase& phase) const {
    const T turns = motion_.at_turns_of(time);
    if (T(1) / T(8) < magnitude(turns)) {
      const Displaced<T> wall = motion_.at_phase(phase());
      return {with_wall(wall, time), wall.place, wall.speed};
    }
    const T angle = motion_.frequency() * time;
    const UnitVector<T> rest = motion_.circle().beyond_linear(angle);
    const T beyond = place_ * rest.cos + speed_ / motion_.frequency() * rest.sin;
    const T gained = speed_ * rest.cos - place_ * motion_.frequency() * (angle + rest.sin);
    const Approach<T> along = straight(gap_, closing_, pull_);
    return {{T(along.gap_after(time) - beyond), T(along.closing_after(time) + gained)},
            T(place_ + speed_ * time + beyond),
            T(speed_ + gained)};
  }
  // How long a gap surely stays open if w grows at most at this rate; nothing: for ever.
  static std::optional<T> open_for(const T& gap, const T& closing, const T& rate) {
    if (!is_positive(closing) && !is_positive(rate)) return {};
    const T square = closing * closing + (rate + rate) * gap;
    if (is_negative(square)) return {};
    const T speed = square_root(square);
    return is_positive(closing) ? T((gap + gap) / (closing + speed)) : T((speed - closing) / rate);
  }
  // Where the series of a gap that closes at w, cut after the fourth order in the time d, is 0; how far from there the
  // gap itself is 0 at most; and w then, but for a term of the fourth order. The rest of the gap is below f d^5/120.
  // Nothing if they do not say that w stays above half of what it is.
  struct NearRoot {
    T in, off, closing;
  };
  static std::optional<NearRoot> near_root(const T& gap, const T& closing, const T& rate, const T& jerk, const T& snap,
                                           const T& f) {
    const T inside = closing * closing + (rate + rate) * gap;
    if (!(is_positive(closing) && is_positive(inside))) return {};
    const auto speed_after = [&](const T& d) { return T(closing + d * (rate + d * (jerk / T(2) + d * snap / T(6)))); };
    const T second = (gap + gap) / (closing + square_root(inside));
    const T in = second - second * second * second * (jerk + second * snap / T(4)) / (T(6) * speed_after(second));
    const auto slows = [](const T& change) { return is_negative(change) ? T(-change) : T(0); };
    const T far = in + in / T(4);
    const T lost = far * (slows(rate) + far * (slows(jerk) / T(2) + far * (slows(snap) + f * far / T(4)) / T(6)));
    if (!(is_positive(in) && lost + lost < closing)) return {};
    const T left = gap - in * (closing + in * (rate / T(2) + in * (jerk + in * snap / T(4)) / T(6)));
    const T square = in * in, off = (magnitude(left) + f * in * (square * square) / T(120)) * T(2) / closing;
    return off < in / T(4) ? std::optional(NearRoot{in, off, speed_after(in)}) : std::nullopt;
  }
  std::optional<WallMeeting<T>> on_sine() const {
    const T never = last_chance(), square = motion_.frequency() * motion_.frequency();
    const T greatest = pull_ + motion_.curving(), changing = motion_.curving() * motion_.frequency();
    const typename WallMotion<T>::Following phases(motion_, since_, turns_);
    const auto at = [&](const T& time) { return on_sine(time, [&] { return phases.rest(time); }); };
    OnSine now = open_ == T(0) ? OnSine{{gap_, closing_}, place_, speed_} : at(open_);
    for (T time = open_;; now = at(time)) {
      const auto [state, place, speed] = now;
      const auto& [gap, closing] = state;
      const T rate = pull_ - square * place;
      if (!is_positive(gap) && is_positive(closing)) {  // closed just before, or by rounding
        const T inside = closing * closing + (rate + rate) * gap;
        const T when = time + (gap + gap) / (closing + (is_positive(inside) ? T(square_root(inside)) : T(0)));
        const T there = at(when).state.closing;
        return WallMeeting<T>{when, is_positive(there) ? there : closing};
      }
      const T open = is_positive(gap) ? gap : T(0), fifth = changing * square;
      const auto root = near_root(open, closing, rate, T(-square * speed), T(square * square * place), fifth);
      if (root && !(time + root->in < T(time + root->in) + root->off) &&
          fifth * root->in * root->in * (root->in * root->in) < T(4) * T(std::numeric_limits<T>::epsilon()) * closing)
        return WallMeeting<T>{T(time + root->in), root->closing};  // the rest of w is a 24th of what is asked above
      const auto surely = root ? std::optional<T>(root->in - root->off) : open_for(open, closing, greatest);
      if (!surely) return {};
      T wait = *surely;
      if (!root) {
        // Within four times as long or until the acceleration has changed its sign on the mean; from size and speed 0
        // not quite until then, since rounding would have the sign.
        const T times(*surely == T(0) ? 2 : 3), within = std::max(T(4) * *surely, times * magnitude(rate) / changing);
        const T less = rate + changing * within / T(3);  // a third of the change acts on the gap
        if (less < greatest) wait = std::max(wait, std::min(within, open_for(open, closing, less).value_or(within)));
      }
      const Approach<T> to_place = straight(T(gap + place), T(closing - speed), pull_);
      const auto free = out_of_reach(to_place.gap_after(wait), to_place.closing_after(wait));
      if (!free) return {};
      wait += *free;
      const T next = time + wait, rounding = roundings(RoundsToNearest<T> ? time : T(time + since_.high));
      if (!(time < next)) return unresolved(time, closing);
      if (is_positive(time) && is_positive(gap) && gap < motion_.curving() * rounding * rounding &&
          !(motion_.amplitude() < gap + place))
        return unresolved(time, closing);  // below a top that is no further than the rounding of the time
      if (never < next) return {};
      time = next;
    }
  }

  T gap_, closing_, pull_, splitter_;
  const WallMotion<T>& motion_;
  Pair<T> since_, turns_;
  Phase<T> phase_;
  T place_, speed_;  // of the wall, at the time 0
  T open_;
};

}  // namespace cradle
