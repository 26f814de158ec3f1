#pragma once
// Whether the collisions of a chain whose masses are watched are those of the exact system, as far as its deviations
// show (watched_gap.hpp). The first one that may not be is entered in the account; what follows is the motion of
// another system, and nothing more is estimated.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "cradle/core/chains/watched_gap.hpp"
#include "cradle/core/engine/event_queue.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/wall.hpp"

namespace cradle {

// Gaps: TimedGaps of WatchedGap.
template <Real T, class Gaps> class Certainty {
 public:
  // A collision is to be made at the gap s, between p and n, and their deviations to be those after it. Called before
  // the gaps change.
  template <class Masses>
  void collision(Gaps& gaps, Slot p, Slot s, Slot n, ParticleIndex particle, const T& time, const Outcome<T>& outcome,
                 const Masses& masses, bool exact_sums) {
    const double w = to_double(gaps[s].closing);
    const double slope = std::exchange(slope_, 0);
    if (gaps.account().uncertain > 0 || !(w > 0)) return;  // slower than any double: not estimated
    const double since = to_double(gaps.flown(s, time));
    Deviation here = gaps[s].off.after(since);
    for (double& off : here.gap) off += w * (magnitude(to_double(time)) + magnitude(since)) * roundings_.next();
    if (exceeds(Deviation::largest(here.closing), w) || doubtful(gaps, p, s, time, here, w) ||
        doubtful(gaps, n, s, time, here, w))
      return doubt(gaps, particle, time, Deviation::largest(here.gap));
    bring(gaps, p, time);
    if (n != p) bring(gaps, n, time);
    const double back = to_double(outcome.closing) / w, own = slope < 0 || slope > 0 ? slope : back;
    const double change = (1 - own) / (1 - back);  // of what is handed over, against that of a constant restitution
    const auto hand = [&](Slot to, double share) {
      gaps[to].off.add(seen_from(gaps, to, time, here), share, share * change);
    };
    hand(p, to_double(outcome.to_left) / w);
    hand(n, to_double(outcome.to_right) / w);
    gaps[s].off = {};
    gaps[s].off.add(here, back, own);
    for (std::size_t k = 0; k < Deviation::samples; ++k) last_[k] = here.gap[k] / w;
    round(gaps, p, s, n, outcome, masses);
    if (!exact_sums)
      for (const Slot beside : {p, n})
        for (double& off : gaps[beside].off.closing)
          off += (magnitude(to_double(gaps[beside].closing)) + w) * roundings_.next();
    if (since < 0) gaps[s].off = gaps[s].off.after(-since);
  }

  // A threshold of the law, of a collision that is to be made at the gap s.
  void threshold(Gaps& gaps, Slot s, ParticleIndex particle, const T& time, const T& speed) const {
    if (gaps.account().uncertain > 0 || !is_positive(speed)) return;
    const Deviation here = gaps[s].off.after(to_double(gaps.flown(s, time)));
    if (exceeds(Deviation::largest(here.closing), to_double(T(magnitude(T(gaps[s].closing - speed))))))
      doubt(gaps, particle, time, Deviation::largest(here.gap));
  }

  // dw'/dw at the collision to be made next, of a law whose restitution depends on the speed.
  template <class Law, class Masses>
  void slope(const Law& law, const T& w, const Masses& masses, const Outcome<T>& at) {
    const T step = w / T(1 << 20);
    slope_ = to_double(T((law(T(w + step), masses).closing - at.closing) / step));
  }

  // Counts the deviations of all gaps held from a new time (watched_gap.hpp).
  void begin_anew(Gaps& gaps, Slot first, Slot last) {
    for (Slot s = first; s <= last; ++s) gaps[s].off.shift(last_, to_double(gaps[s].closing));
    for (std::size_t k = 0; k < Deviation::samples; ++k) delay_[k] += std::exchange(last_[k], 0);
  }

  // Whether a collision at the gap s may come before or after the time, which ends the run.
  bool open(const Gaps& gaps, Slot s, const T& time) const {
    Deviation off = gaps[s].off.after(to_double(gaps.flown(s, time)));
    off.shift(delay_, -to_double(gaps[s].closing));
    return exceeds(Deviation::largest(off.gap), to_double(gaps.gap_at(s, gaps[s].closing, time)));
  }

  static auto state(auto& self) {
    return std::tie(self.roundings_, self.last_[0], self.last_[1], self.delay_[0], self.delay_[1]);
  }

 private:
  static bool exceeds(double off, double what) {
    return Deviation::certain_by * to_double(std::numeric_limits<T>::epsilon()) * off > what;
  }
  // Whether the gap beside the collision at s may have closed before.
  static bool doubtful(const Gaps& gaps, Slot beside, Slot s, const T& time, const Deviation& here, double w) {
    const T since = gaps.flown(beside, time);
    if (beside == s || is_negative(since)) return false;  // late collisions commute with what came before
    const auto& cell = gaps[beside];
    const T gap = gaps.gap_at(beside, cell.closing, time);
    const Deviation there = cell.off.after(to_double(since));
    const double ratio = to_double(cell.closing) / w;
    double off = 0;
    for (std::size_t k = 0; k < Deviation::samples; ++k)
      off = std::max(off, magnitude(there.gap[k] - ratio * here.gap[k]));
    return exceeds(off, to_double(gap)) && !(to_double(gap) == 0 && is_positive(gap));
  }
  static void doubt(Gaps& gaps, ParticleIndex particle, const T& time, double off) {
    gaps.doubt({gaps.clock().time(time), particle, T(exactly<T>(off) * T(std::numeric_limits<T>::epsilon()))});
  }
  // To the time of a collision beside it; g - w t is rounded.
  void bring(Gaps& gaps, Slot s, const T& time) {
    const double since = to_double(gaps.flown(s, time));
    auto& cell = gaps[s];
    if (since < 0) return;
    cell.off = cell.off.after(since);
    const double size = magnitude(to_double(cell.gap)) + magnitude(to_double(cell.closing) * since);
    for (double& off : cell.off.gap) off += size * roundings_.next();
  }
  // What a gap takes of it as of its own local time, where that is later.
  static Deviation seen_from(const Gaps& gaps, Slot s, const T& time, const Deviation& here) {
    const double since = to_double(gaps.flown(s, time));
    return since < 0 ? here.after(-since) : here;
  }
  // Rounding of what the heavier particle is handed, the lighter one and the gap: their sum is exact. Masses are
  // rounded once and for all.
  template <class Masses>
  void round(Gaps& gaps, Slot p, Slot s, Slot n, const Outcome<T>& outcome, const Masses& masses) {
    const double left = to_double(outcome.to_left), right = to_double(outcome.to_right);
    const bool light_left = left > right;
    for (std::size_t k = 0; k < Deviation::samples; ++k) {
      const double ratio = (Roundings::of(to_double(masses.left), k) - Roundings::of(to_double(masses.right), k)) / 2;
      const double kick = std::min(left, right) * (ratio + 2 * roundings_.next());
      const double back = to_double(outcome.closing) * roundings_.next();
      gaps[light_left ? n : p].off.closing[k] += kick;
      gaps[light_left ? p : n].off.closing[k] -= kick + back;
      gaps[s].off.closing[k] += back;
    }
  }

  using Delays = std::array<double, Deviation::samples>;
  Roundings roundings_;
  Delays last_{},
      delay_{};       // by which the last collision is late, since the deviations are counted; in all times before
  double slope_ = 0;  // 0: w'/w
};

}  // namespace cradle
