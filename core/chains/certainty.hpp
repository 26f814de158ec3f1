#pragma once
// Whether the collisions of a chain with watched masses are those of the exact system, as its deviations show
// (watched_gap.hpp). The first one that may not be is entered in the account; afterwards the motion is that of another
// system, and nothing more is estimated.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "cradle/core/chains/watched_gap.hpp"
#include "cradle/core/queue/event_queue.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/wall.hpp"

namespace cradle {

// Gaps: TimedGaps of WatchedGap.
template <Real T, class Gaps> class Certainty {
  using N = DeviationNumber<T>;
  using Off = Deviation<N>;

 public:
  // Computes the deviations after the next collision, which is at the gap s between p and n. Called before the gaps
  // change.
  template <class Masses>
  void collision(Gaps& gaps, Slot p, Slot s, Slot n, ParticleIndex particle, const T& time, const Outcome<T>& outcome,
                 const Masses& masses, bool exact_sums) {
    const N w = number(gaps[s].closing);
    const N slope = std::exchange(slope_, N(0));
    if (gaps.account().uncertain > 0) return;
    const N since = number(gaps.flown(s, time));
    Off here = gaps[s].off.after(since);
    for (N& off : here.gap) off += w * (magnitude(number(time)) + magnitude(since)) * roundings_.next();
    if (exceeds(Off::largest(here.closing), w) || doubtful(gaps, p, s, time, here, w) ||
        doubtful(gaps, n, s, time, here, w))
      return doubt(gaps, particle, time, Off::largest(here.gap));
    bring(gaps, p, time);
    if (n != p) bring(gaps, n, time);
    const N back = number(outcome.closing) / w, own = slope == N(0) ? back : slope;
    const N change = (N(1) - own) / (N(1) - back);  // of the impulse, relative to that of a constant restitution
    const auto hand = [&](Slot to, const N& share) {
      gaps[to].off.add(seen_from(gaps, to, time, here), share, share * change);
    };
    hand(p, number(outcome.to_left) / w);
    hand(n, number(outcome.to_right) / w);
    gaps[s].off = {};
    gaps[s].off.add(here, back, own);
    for (std::size_t k = 0; k < Off::samples; ++k) last_[k] = here.gap[k] / w;
    round(gaps, p, s, n, outcome, masses);
    if (!exact_sums)
      for (const Slot beside : {p, n})
        for (N& off : gaps[beside].off.closing)
          off += (magnitude(number(gaps[beside].closing)) + w) * roundings_.next();
    if (is_negative(since)) gaps[s].off = gaps[s].off.after(-since);
  }

  // Checks a threshold of the law in the next collision, at the gap s.
  void threshold(Gaps& gaps, Slot s, ParticleIndex particle, const T& time, const T& speed) const {
    if (gaps.account().uncertain > 0 || !is_positive(speed)) return;
    const Off here = gaps[s].off.after(number(gaps.flown(s, time)));
    if (exceeds(Off::largest(here.closing), number(T(magnitude(T(gaps[s].closing - speed))))))
      doubt(gaps, particle, time, Off::largest(here.gap));
  }

  // dw'/dw at the next collision, for a law whose restitution depends on the speed.
  template <class Law, class Masses>
  void slope(const Law& law, const T& w, const Masses& masses, const Outcome<T>& at) {
    const T step = w / T(1 << 20);
    slope_ = number(T((law(T(w + step), masses).closing - at.closing) / step));
  }

  // Counts the deviations of all held gaps from a new time (watched_gap.hpp).
  void begin_anew(Gaps& gaps, Slot first, Slot last) {
    for (Slot s = first; s <= last; ++s) gaps[s].off.shift(last_, number(gaps[s].closing));
    for (std::size_t k = 0; k < Off::samples; ++k) delay_[k] += std::exchange(last_[k], N(0));
  }

  // Whether a collision at the gap s may come before or after this time, which is the end of the run.
  bool open(const Gaps& gaps, Slot s, const T& time) const {
    Off off = gaps[s].off.after(number(gaps.flown(s, time)));
    off.shift(delay_, -number(gaps[s].closing));
    return exceeds(Off::largest(off.gap), number(gaps.gap_at(s, gaps[s].closing, time)));
  }

  static auto state(auto& self) {
    return std::tie(self.roundings_, self.last_[0], self.last_[1], self.delay_[0], self.delay_[1]);
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
  // Whether the gap beside the collision at s may have closed earlier.
  static bool doubtful(const Gaps& gaps, Slot beside, Slot s, const T& time, const Off& here, const N& w) {
    const T since = gaps.flown(beside, time);
    if (beside == s || is_negative(since)) return false;  // late collisions commute with earlier ones
    const auto& cell = gaps[beside];
    const T gap = gaps.gap_at(beside, cell.closing, time);
    const Off there = cell.off.after(number(since));
    const N ratio = number(cell.closing) / w;
    N off(0);
    for (std::size_t k = 0; k < Off::samples; ++k)
      off = std::max<N>(off, magnitude(N(there.gap[k] - ratio * here.gap[k])));
    return exceeds(off, number(gap));
  }
  static void doubt(Gaps& gaps, ParticleIndex particle, const T& time, const N& off) {
    gaps.doubt({gaps.clock().time(time), particle, T(scalar(off) * T(std::numeric_limits<T>::epsilon()))});
  }
  // Advances the deviation to the time of a neighbouring collision; g - w t is rounded.
  void bring(Gaps& gaps, Slot s, const T& time) {
    const N since = number(gaps.flown(s, time));
    auto& cell = gaps[s];
    if (is_negative(since)) return;
    cell.off = cell.off.after(since);
    const N size = magnitude(number(cell.gap)) + magnitude(N(number(cell.closing) * since));
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
    const bool light_left = left > right;
    for (std::size_t k = 0; k < Off::samples; ++k) {
      const N ratio =
          (Roundings<N>::of(to_double(masses.left), k) - Roundings<N>::of(to_double(masses.right), k)) / N(2);
      const N kick = std::min<N>(left, right) * (ratio + N(2) * roundings_.next());
      const N back = number(outcome.closing) * roundings_.next();
      gaps[light_left ? n : p].off.closing[k] += kick;
      gaps[light_left ? p : n].off.closing[k] -= kick + back;
      gaps[s].off.closing[k] += back;
    }
  }

  using Delays = typename Off::Samples;
  Roundings<N> roundings_;
  Delays last_{N(0), N(0)},
      delay_{N(0), N(0)};  // error of the time of the last collision since deviations are counted; of all times before
  N slope_{0};             // 0: w'/w
};

}  // namespace cradle
