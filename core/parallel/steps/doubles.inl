// Collisions in double: a part of steps.cpp, which includes it once for each kind of vectors. The operations are those
// of the event loop one for one, so that their bits are the same.

#include "cradle/core/parallel/steps/restitution.inl"

namespace cradle {
namespace HWY_NAMESPACE {

// Two numbers that are computed at once, by any processor: those of the gaps left and right of a collision, or two of
// one gap.
typedef double Both __attribute__((vector_size(16), may_alias));
HWY_INLINE Both both(double x) { return Both{x, x}; }
HWY_INLINE Both lower(Both a, Both b) { return Both{a[0], b[0]}; }
HWY_INLINE Both upper(Both a, Both b) { return Both{a[1], b[1]}; }
HWY_INLINE Both least(Both a, Both b) { return a < b ? a : b; }
// The numbers of a gap as they lie in memory: gap and local time, then time of collision and closing speed.
HWY_INLINE Both* pairs(Gap<double>& cell) { return reinterpret_cast<Both*>(&cell.gap); }
static_assert(sizeof(Gap<double>) == 2 * sizeof(Both) && alignof(Gap<double>) % alignof(Both) == 0);

// What is known of all collisions of a step.
struct Made {
  Both flown = both(StepLine::never), own_flown = flown;  // least times since the collision before: beside, and own
  Both gap = flown;                                       // least gaps beside
  double latest;
  hn::Vec<Lanes> lost = hn::Zero(Lanes()), rest = hn::Zero(Lanes());  // for the ledger
  std::uint64_t below_cutoff = 0;

  // Whether every collision came after the last ones at its gaps and left no gap below the floor.
  HWY_INLINE bool in_order(double floor, double end) const {
    return std::min(flown[0], flown[1]) > 0 && own_flown[0] > end * 0x1p-40 && std::min(gap[0], gap[1]) >= floor;
  }
};

// Makes the collision at the gap i, number k of its pass: beside it g -= w since, w += gain.
template <StepLaw law, bool unequal>
HWY_INLINE void collide(const StepLine& line, Local& l, const StepTask& task, std::size_t i, std::size_t k,
                        Made& made) {
  Both *const left = pairs(l.cells[i - 1]), *const own = pairs(l.cells[i]), *const right = pairs(l.cells[i + 1]);
  const double time = l.due[i], w = own[1][1];
  const Both x = both(time), g = lower(left[0], right[0]), then = upper(left[0], right[0]),
             u = Both{left[1][1], right[1][1]};
  double after = 0;
  Both gain{};
  if constexpr (law == StepLaw::any) {
    after = line.after[k], gain = Both{line.to_left[k], line.to_right[k]};
  } else {
    double handed = 0;  // to each side, as far as masses are equal
    if constexpr (law == StepLaw::of_speed) {
      after = line.after[k], handed = line.to_left[k];
    } else if constexpr (law == StepLaw::hard) {
      handed = (w < task.cutoff ? 1 : task.half_sum) * w;
      after = w - (handed + handed);
    } else {
      after = -((w < task.cutoff ? 1 : task.restitution) * w);
      handed = (w - after) * 0.5;
    }
    gain = both(handed);
    if constexpr (unequal) {
      const double share = l.fraction[i], all = handed + handed, small = all * std::abs(share), large = all - small;
      gain = Both{share, -share} < 0 ? both(large) : both(small);
      l.struck_mass[k] = l.reduced[i];
    }
    l.struck[k] = w;
  }
  Both since = x - then;
  if (std::min(then[0], then[1]) < 0) [[unlikely]]
    since -= then < 0 ? Both{l.lag[i - 1], l.lag[i + 1]} : both(0);
  const Both g_now = g - u * since, u_now = u + gain;
  made.flown = least(since, made.flown);
  made.own_flown = least(x - upper(own[0], own[0]), made.own_flown);
  made.gap = least(g_now, made.gap);
  made.latest = time > made.latest ? time : made.latest;
  left[0] = lower(g_now, x), right[0] = upper(g_now, x);
  l.cells[i - 1].closing = u_now[0], l.cells[i + 1].closing = u_now[1];
  own[0] = Both{0, time}, own[1] = Both{StepLine::never, after};
  l.due[i] = StepLine::never;
}

// When the gaps beside the collision at the gap i are due now.
HWY_INLINE void foresee(Local& l, double end, std::size_t i) {
  Gap<double>&left = l.cells[i - 1], &right = l.cells[i + 1];
  const Both x = both(l.cells[i].time), g{left.gap, right.gap}, u{left.closing, right.closing},
             was_due{l.due[i - 1], l.due[i + 1]};
  const Both due = u > 0 ? x + g / u : both(StepLine::never);
  left.due = l.due[i - 1] = due[0];
  right.due = l.due[i + 1] = due[planted(3) ? 0 : 1];
  const auto soon = (due <= end) & (was_due > end);
  follow(l, i - 1, soon[0] & 1, i + 1, soon[1] & 1);
}

// Enters the collisions of a pass in the ledger (ledger.hpp), by their closing speeds in `struck`.
template <StepLaw law, bool unequal>
HWY_INLINE void enter(const StepLine& line, const Local& l, const StepTask& task, Made& made) {
  const Lanes d;
  hn::StoreU(hn::Zero(d), d, l.struck + l.firsts);
  if (unequal) hn::StoreU(hn::Zero(d), d, l.struck_mass + l.firsts);
  const auto cutoff = hn::Set(d, task.cutoff), share = hn::Set(d, task.lost), rounder = hn::Set(d, task.rounder),
             per_fine = hn::Set(d, task.per_fine), whole = hn::Set(d, 0x1.8p52);
  for (std::size_t k = 0; k < l.firsts; k += lanes) {
    const auto w = hn::LoadU(d, l.struck + k);
    const auto elastic = hn::Lt(w, cutoff);
    made.below_cutoff += hn::CountTrue(d, hn::And(elastic, hn::Gt(w, hn::Zero(d))));
    auto factor =
        law == StepLaw::of_speed ? hn::LoadU(d, line.to_right.data() + k) : hn::IfThenZeroElse(elastic, share);
    if (unequal) factor = hn::Mul(factor, hn::LoadU(d, l.struck_mass + k));
    const auto loss = hn::Mul(factor, hn::Mul(w, w));
    const auto coarse = hn::Sub(hn::Add(loss, rounder), rounder);
    made.lost = hn::Add(made.lost, coarse);
    const auto fine = hn::Mul(hn::Sub(loss, coarse), per_fine);
    made.rest = hn::Add(made.rest, hn::Sub(hn::Add(fine, whole), whole));  // rounded
  }
}

// The collisions of a step, where numbers are doubles.
template <StepLaw law, bool unequal> struct Doubles {
  Made made;

  HWY_INLINE Doubles(const StepTask&, const StepResult& before) : made{.latest = before.last} {}

  // Makes those that are first in a pass. In two loops: the shorter a turn, the more of them are in the processor at
  // once, and each operation waits for the one before (1.2 times as fast as one loop).
  HWY_INLINE void make(StepLine& line, Local& l, const StepTask& task, StepScalars& scalars, double end) {
    if (law == StepLaw::of_speed && l.firsts > 0) {
      for (std::size_t k = 0; k < l.firsts; ++k) l.struck[k] = l.cells[l.first[k]].closing;
      if (!OfSpeed(task)(l.struck, l.firsts, line.after.data(), line.to_left.data(), line.to_right.data()))
        return make_by<StepLaw::any, false>(line, l, task, scalars, end);
    }
    make_by<law, unequal>(line, l, task, scalars, end);
  }
  template <StepLaw as, bool masses_too>
  HWY_INLINE void make_by(StepLine& line, Local& l, const StepTask& task, StepScalars& scalars, double end) {
    if (as == StepLaw::any) scalars.outcomes(l.first, l.firsts);
    for (std::size_t k = 0; k < l.firsts; ++k) collide<as, masses_too>(line, l, task, l.first[k], k, made);
    for (std::size_t k = 0; k < l.firsts; ++k) foresee(l, end, l.first[k]);
    if (as != StepLaw::any) enter<as, masses_too>(line, l, task, made);
  }
  // Whether all of them were in order.
  HWY_INLINE bool report(const StepTask& task, double end, StepResult& result) const {
    result.last = made.latest;
    result.lost += hn::GetLane(hn::SumOfLanes(Lanes(), made.lost));
    result.rest += hn::GetLane(hn::SumOfLanes(Lanes(), made.rest));
    result.below_cutoff += made.below_cutoff;
    return made.in_order(task.floor, end);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace cradle
