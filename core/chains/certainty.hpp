#pragma once
// `Certainty` estimates whether a chain with watched masses makes the collisions of the exact system. It uses the
// deviations of the gaps, estimates of how far rounding has moved each gap from the exact motion (watched_gap.hpp). The
// first collision that may not be one of the exact system is entered in the account. From then on the run may follow
// another motion, so nothing more is estimated.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/chains/watched_gap.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

// How a gap moves at a given time: the time since its local time (`since`), its size, its closing speed, and the rate
// at which the closing speed grows.
template <Real T> struct GapMotion { T since, gap, closing, acceleration{0}; };

// `Gaps` is a TimedGaps of WatchedGap. A `Motion` is called as motion(s, time) and returns the GapMotion of the slot s
// at that time; `Motion::curved` says whether some closing speeds change between collisions.
template <Real T, class Gaps> class Certainty {
  using N = DeviationNumber<T>;
  using Off = Deviation<N>;

 public:
  // Says which neighbouring gaps a collision changes: a particle that comes to rest on others does not move those.
  struct Moved {
    bool left = true, right = true;
  };

  // Computes the deviations after the next collision, which is at the gap s between p and n and closes at the speed w.
  // It is called before the gaps change.
  template <class Motion, class Masses>
  void collision(Gaps& gaps, const Motion& motion, Slot p, Slot s, Slot n, ParticleIndex particle, const T& time,
                 const T& speed, const Outcome<T>& outcome, const Masses& masses, bool exact_sums,
                 const Moved& moved = {}) {
    const N w = number(speed);
    const N slope = std::exchange(slope_, N(0));
    if (gaps.account().uncertain > 0) return;
    const GapMotion<T> own_motion = motion(s, time);
    const N since = number(own_motion.since), acceleration = number(own_motion.acceleration);
    Off here = gaps[s].off.after(since);
    for (N& off : here.gap) off += w * (magnitude(number(time)) + magnitude(since)) * roundings_.next();
    if constexpr (Motion::curved) meet(here, own_motion, w);
    if (exceeds(Off::largest(here.closing), w) || doubtful(gaps, motion, p, s, time, here, w) ||
        doubtful(gaps, motion, n, s, time, here, w))
      return doubt(gaps, particle, time, Off::largest(here.gap));
    if constexpr (Motion::curved)
      if (!is_positive(w)) {  // it touches the wall, at rest, and nothing changes
        gaps[s].off = {};
        return;
      }
    bring(gaps, motion, p, time);
    if (n != p) bring(gaps, motion, n, time);
    const Off left = gaps[p].off, right = gaps[n].off;
    const N back = number(outcome.closing) / w, own = slope == N(0) ? back : slope;
    const N change = (N(1) - own) / (N(1) - back);  // of the impulse, relative to that of a constant restitution
    const auto hand = [&](Slot to, const N& share) {
      gaps[to].off.add(seen_from(gaps, to, time, here), share, share * change);
    };
    hand(p, number(outcome.to_left) / w);
    hand(n, number(outcome.to_right) / w);
    gaps[s].off = {};
    gaps[s].off.add(here, back, own);
    for (std::size_t k = 0; k < Off::samples; ++k) {
      last_[k] = here.gap[k] / w;
      if constexpr (Motion::curved) gaps[s].off.closing[k] -= acceleration * last_[k];
    }
    round(gaps, p, s, n, outcome, masses);
    if (!exact_sums)
      for (const Slot beside : {p, n})
        for (N& off : gaps[beside].off.closing)
          off += (magnitude(number(motion(beside, time).closing)) + w) * roundings_.next();
    if (is_negative(since)) gaps[s].off = gaps[s].off.after(-since);
    if constexpr (Motion::curved) {
      if (!moved.left) gaps[p].off = left;
      if (!moved.right) gaps[n].off = right;
      if (outcome.closing == T(0) && is_positive(acceleration)) gaps[s].off = {};  // it rests on the wall
    }
  }

  // Checks a threshold of the law in the next collision, at the gap s, which closes at the speed w.
  template <class Motion>
  void threshold(Gaps& gaps, const Motion& motion, Slot s, ParticleIndex particle, const T& time, const T& w,
                 const T& speed) const {
    if (gaps.account().uncertain > 0 || !is_positive(speed)) return;
    const GapMotion<T> own = motion(s, time);
    Off here = gaps[s].off.after(number(own.since));
    if constexpr (Motion::curved) meet(here, own, number(w));
    if (exceeds(Off::largest(here.closing), number(T(magnitude(T(w - speed))))))
      doubt(gaps, particle, time, Off::largest(here.gap));
  }

  // Checks whether a wall is met, at a gap that has just changed. `meets` gives the time until a gap that is smaller,
  // and closes faster, by given amounts meets the wall; or nothing, if it does not.
  template <class Meets>
  void meeting(Gaps& gaps, Slot s, ParticleIndex particle, const T& time, const Meets& meets) const {
    if (gaps.account().uncertain > 0) return;
    const Off& off = gaps[s].off;
    const T unit = T(Off::certain_by) * T(std::numeric_limits<T>::epsilon());
    const T gap = T(unit * scalar(Off::largest(off.gap))), closing = T(unit * scalar(Off::largest(off.closing)));
    if (gap == T(0) && closing == T(0)) return;
    const auto met = meets(T(0), T(0)), before = meets(gap, closing), after = meets(T(-gap), T(-closing));
    const auto apart = [&](const auto& other) {
      if (other.has_value() != met.has_value()) return true;
      if (!met) return false;
      const T later = magnitude(T(other->in - met->in)), allowed = T(gap + closing * met->in);
      return T(T(4) * allowed) < later * met->speed;
    };
    if (apart(before) || apart(after)) doubt(gaps, particle, time, Off::largest(off.gap));
  }

  // dw'/dw at the next collision, for a law whose restitution depends on the speed.
  template <class Law, class Masses>
  void slope(const Law& law, const T& w, const Masses& masses, const Outcome<T>& at) {
    const T step = w / T(1 << 20);
    slope_ = number(T((law(T(w + step), masses).closing - at.closing) / step));
  }

  // Counts the deviations of all held gaps from a new time (watched_gap.hpp).
  template <class Motion> void begin_anew(Gaps& gaps, const Motion& motion, Slot first, Slot last) {
    for (Slot s = first; s <= last; ++s) {
      N acceleration(0);
      if constexpr (Motion::curved) acceleration = number(motion.at_local_time(s).acceleration);
      gaps[s].off.shift(last_, number(gaps[s].closing), acceleration);
    }
    for (std::size_t k = 0; k < Off::samples; ++k) delay_[k] += std::exchange(last_[k], N(0));
  }

  // Advances the deviation of a gap to a time at which nothing else happens to it.
  template <class Motion> void renew(Gaps& gaps, const Motion& motion, Slot s, const T& time) {
    if (gaps.account().uncertain == 0) bring(gaps, motion, s, time);
  }

  // Whether a collision at the gap s may come before or after this time, which is the end of the run and is itself off
  // by `off_by`.
  template <class Motion>
  bool open(const Gaps& gaps, const Motion& motion, Slot s, const T& time, const T& off_by) const {
    const GapMotion<T> now = motion(s, time);
    Off off = gaps[s].off.after(number(now.since));
    off.shift(delay_, -number(now.closing), -number(now.acceleration));
    return exceeds(Off::largest(off.gap), number(T(now.gap - magnitude(now.closing) * off_by)));
  }

  // A sample of how far the closing speed of a gap is off at a time, in which nothing else happens.
  template <class Motion>
  T closing_off(const Gaps& gaps, const Motion& motion, Slot s, const T& time, std::size_t sample) const {
    const GapMotion<T> now = motion(s, time);
    Off off = gaps[s].off.after(number(now.since));
    off.shift(delay_, -number(now.closing), -number(now.acceleration));
    return T(std::numeric_limits<T>::epsilon()) * scalar(off.closing[sample]);
  }

  static auto state(auto& self) {
    return fields(self.roundings_, self.last_[0], self.last_[1], self.delay_[0], self.delay_[1]);
  }

 private:
  static N number(const T& x) { return deviation_number(x); }
  static T scalar(const N& x) {
    if constexpr (std::same_as<N, T>)
      return x;
    else
      return exactly<T>(x);
  }
  static bool exceeds(const N& off, const N& what) {
    return N(Off::certain_by) * number(std::numeric_limits<T>::epsilon()) * off > what;
  }
  // The deviation of the speed at which a gap meets a wall, instead of that at a given time.
  static void meet(Off& here, const GapMotion<T>& motion, const N& w) {
    if (motion.acceleration == T(0) || !is_positive(w)) return;
    for (std::size_t k = 0; k < Off::samples; ++k) here.closing[k] += number(motion.acceleration) * here.gap[k] / w;
  }
  // Whether the gap beside the collision at s may have closed earlier.
  template <class Motion>
  static bool doubtful(const Gaps& gaps, const Motion& motion, Slot beside, Slot s, const T& time, const Off& here,
                       const N& w) {
    const GapMotion<T> now = motion(beside, time);
    if (beside == s || is_negative(now.since)) return false;  // late collisions commute with earlier ones
    // Particles that touch, since a collision at this time or in a pile, collide by a rule, not by their times.
    if (now.gap == T(0) && now.since == T(0)) return false;
    const Off there = gaps[beside].off.after(number(now.since));
    N off(0);
    if (is_positive(w)) {
      const N ratio = number(now.closing) / w;
      for (std::size_t k = 0; k < Off::samples; ++k)
        off = std::max<N>(off, magnitude(N(there.gap[k] - ratio * here.gap[k])));
    }
    return exceeds(off, number(now.gap));
  }
  static void doubt(Gaps& gaps, ParticleIndex particle, const T& time, const N& off) {
    gaps.doubt({gaps.clock().time(time), particle, T(scalar(off) * T(std::numeric_limits<T>::epsilon()))});
  }
  // Advances the deviation to the time of a neighbouring collision; g - w t is rounded.
  template <class Motion> void bring(Gaps& gaps, const Motion& motion, Slot s, const T& time) {
    const GapMotion<T> now = motion(s, time);
    const N since = number(now.since);
    auto& cell = gaps[s];
    if (is_negative(since)) return;
    cell.off = cell.off.after(since);
    const N own_way = magnitude(N(number(cell.closing) * since));
    if constexpr (Motion::curved)
      if (const N gained = magnitude(N(number(T(now.closing - cell.closing)))); gained > N(0)) {
        const N fastest = magnitude(number(cell.closing)) + gained;
        for (N& off : cell.off.gap) off += (magnitude(number(cell.gap)) + fastest * since) * roundings_.next();
        for (N& off : cell.off.closing) off += fastest * roundings_.next();
        return;
      }
    const N size = magnitude(number(cell.gap)) + own_way;
    for (N& off : cell.off.gap) off += size * roundings_.next();
  }
  // The deviation of a collision for a neighbouring gap, at that gap's local time if it is later.
  static Off seen_from(const Gaps& gaps, Slot s, const T& time, const Off& here) {
    const N since = number(gaps.flown(s, time));
    return is_negative(since) ? here.after(-since) : here;
  }
  // Rounding errors of the gain of the heavier particle, of that of the lighter one and of the gap: their sum is exact.
  // Masses are rounded only once.
  template <class Masses>
  void round(Gaps& gaps, Slot p, Slot s, Slot n, const Outcome<T>& outcome, const Masses& masses) {
    const N left = number(outcome.to_left), right = number(outcome.to_right);
    const N smaller = std::min<N>(left, right), larger = std::max<N>(left, right);
    const N rounded = larger > N(15) * smaller ? smaller : larger;  // the smaller one is what the other one leaves
    const bool light_left = left > right;
    for (std::size_t k = 0; k < Off::samples; ++k) {
      const N ratio =
          (Roundings<N>::of(to_double(masses.left), k) - Roundings<N>::of(to_double(masses.right), k)) / N(2);
      const N kick = smaller * ratio + rounded * N(2) * roundings_.next();
      const N back = number(outcome.closing) * roundings_.next();
      gaps[light_left ? n : p].off.closing[k] += kick;
      gaps[light_left ? p : n].off.closing[k] -= kick + back;
      gaps[s].off.closing[k] += back;
    }
  }

  using Delays = typename Off::Samples;
  Roundings<N> roundings_;
  // Errors of the time of the last collision, since deviations were counted anew, and the sum of those before.
  Delays last_{N(0), N(0)}, delay_{N(0), N(0)};
  N slope_{0};  // 0: w'/w
};

}  // namespace cradle
