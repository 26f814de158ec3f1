#pragma once
// Whether the contacts of a chain whose masses are far apart are those of the exact system, as far as its deviations
// tell (far_gap.hpp). The first one that is not is entered in the account; what follows is the motion of another
// system, and nothing more is estimated.

#include <cmath>
#include <limits>

#include "cradle/core/event_queue.hpp"
#include "cradle/core/far_gap.hpp"
#include "cradle/core/law.hpp"
#include "cradle/core/wall.hpp"

namespace cradle {

// Gaps: TimedGaps of FarGap.
template <Real T, class Gaps> class Certainty {
 public:
  // A contact is to be made at the gap s, between p and n, and their deviations to be those after it. Called before the
  // gaps change.
  template <class Masses>
  void contact(Gaps& gaps, Slot p, Slot s, Slot n, BodyIndex body, const T& time, const Outcome<T>& outcome,
               const Masses& masses) {
    const double w = to_double(gaps[s].closing);
    if (gaps.account().uncertain > 0 || !(w > 0)) return;  // slower than any double: not estimated
    const double since = to_double(gaps.flown(s, time));
    Deviation here = gaps[s].off.after(since);
    for (double& off : here.gap) off += w * (std::abs(to_double(time)) + std::abs(since)) * roundings_.next();
    if (exceeds(Deviation::largest(here.closing), w) || doubtful(gaps, p, s, time, here, w) ||
        doubtful(gaps, n, s, time, here, w))
      return doubt(gaps, body, time, Deviation::largest(here.gap));
    bring(gaps, p, time);
    if (n != p) bring(gaps, n, time);
    gaps[p].off.add(seen_from(gaps, p, time, here), to_double(outcome.to_left) / w);
    gaps[n].off.add(seen_from(gaps, n, time, here), to_double(outcome.to_right) / w);
    Deviation after;
    after.add(here, to_double(outcome.closing) / w);
    gaps[s].off = after;
    round(gaps, p, s, n, outcome, masses);
    if (since < 0) gaps[s].off = gaps[s].off.after(-since);
  }

  // A threshold of the law, of a contact that is to be made at the gap s.
  void threshold(Gaps& gaps, Slot s, BodyIndex body, const T& time, const T& speed) const {
    if (gaps.account().uncertain > 0 || !is_positive(speed)) return;
    const Deviation here = gaps[s].off.after(to_double(gaps.flown(s, time)));
    if (exceeds(Deviation::largest(here.closing), to_double(T(magnitude(T(gaps[s].closing - speed))))))
      doubt(gaps, body, time, Deviation::largest(here.gap));
  }

  // Whether a contact at the gap s may come before or after the time, which ends the run.
  static bool open(const Gaps& gaps, Slot s, const T& time) {
    const Deviation off = gaps[s].off.after(to_double(gaps.flown(s, time)));
    return exceeds(Deviation::largest(off.gap), to_double(gaps.gap_at(s, gaps[s].closing, time)));
  }

  static auto state(auto& self) { return std::tie(self.roundings_); }

 private:
  static bool exceeds(double off, double what) {
    return Deviation::certain_by * to_double(std::numeric_limits<T>::epsilon()) * off > what;
  }
  // Whether the gap beside the contact at s may have closed before.
  static bool doubtful(const Gaps& gaps, Slot beside, Slot s, const T& time, const Deviation& here, double w) {
    const T since = gaps.flown(beside, time);
    if (beside == s || is_negative(since)) return false;  // late contacts commute with what came before
    const auto& cell = gaps[beside];
    const T gap = gaps.gap_at(beside, cell.closing, time);
    const double off = cell.off.after(to_double(since)).beside(here, to_double(cell.closing) / w);
    return exceeds(off, to_double(gap)) && !(to_double(gap) == 0 && is_positive(gap));
  }
  static void doubt(Gaps& gaps, BodyIndex body, const T& time, double off) {
    gaps.doubt({gaps.clock().time(time), body,
                T(exactly<T>(off) * T(std::numeric_limits<T>::epsilon()))});
  }
  // To the time of a contact beside it; g - w t is rounded.
  void bring(Gaps& gaps, Slot s, const T& time) {
    const double since = to_double(gaps.flown(s, time));
    auto& cell = gaps[s];
    if (since < 0) return;
    cell.off = cell.off.after(since);
    const double size = std::abs(to_double(cell.gap)) + std::abs(to_double(cell.closing) * since);
    for (double& off : cell.off.gap) off += size * roundings_.next();
  }
  // What a gap takes of it as of its own local time, where that is later.
  static Deviation seen_from(const Gaps& gaps, Slot s, const T& time, const Deviation& here) {
    const double since = to_double(gaps.flown(s, time));
    return since < 0 ? here.after(-since) : here;
  }
  // Rounding of what the heavier body is handed, the lighter one and the gap: their sum is exact. Masses are rounded
  // once and for all.
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

  Roundings roundings_;
};

}  // namespace cradle
