// A step on vectors. Google Highway compiles this file once for each kind of vectors and takes the widest ones that the
// processor has; no other file knows it.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cradle/core/parallel/steps/steps.cpp"
#include <hwy/foreach_target.h>  // before highway.h
#include <hwy/highway.h>

#include "cradle/core/parallel/steps/loop.hpp"

HWY_BEFORE_NAMESPACE();
namespace cradle {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Tests plant errors: no radius, no check, a mask of the wrong lane, no bounds of tiles.
#ifndef CRADLE_PLANTED_ERROR
#define CRADLE_PLANTED_ERROR 0
#endif
constexpr bool planted(int error) { return error == CRADLE_PLANTED_ERROR; }

using Lanes = hn::ScalableTag<double>;  // of neighbours that are compared
using Few = hn::CappedTag<double, 4>;   // of the three gaps of a collision and the next one
using Indices = hn::CappedTag<std::uint32_t, hn::MaxLanes(Lanes())>;
constexpr std::size_t lanes = hn::MaxLanes(Lanes()), few = hn::MaxLanes(Few());

// The places of a mask's bits, one after the other: Highway's own Compress copies a large table each time.
struct Places {
  alignas(64) std::uint32_t of[256][8] = {};
  constexpr Places() {
    for (unsigned bits = 0; bits < 256; ++bits)
      for (unsigned k = 0, n = 0; k < 8; ++k)
        if (bits >> k & 1) of[bits][n++] = k;
  }
};
constexpr Places places;

// Appends the numbers of the mask's lanes, counted from `base`, to a list.
template <class Mask> HWY_INLINE void append(Mask mask, std::size_t base, std::uint32_t* list, std::size_t& length) {
  std::uint8_t bits[8];
  hn::StoreMaskBits(Lanes(), mask, bits);
  const unsigned set = bits[0] & ((1U << lanes) - 1);
  const Indices indices;
  hn::StoreU(hn::Add(hn::LoadU(indices, places.of[set]), hn::Set(indices, static_cast<std::uint32_t>(base))), indices,
             list + length);
  length += static_cast<std::size_t>(__builtin_popcount(set));
}

// The arrays and lists of a line, where the compiler keeps them in registers.
struct Local {
  explicit HWY_INLINE Local(StepLine& line)
      : gap(line.gap), closing(line.closing), time(line.time), due(line.due), lag(line.lag), bound(line.bound),
        fraction(line.fraction), reduced(line.reduced), struck(line.struck.data()),
        struck_mass(line.struck_mass.data()), inner_first(line.inner_first), inner(line.inner),
        candidates(line.candidates.data()), waiting(line.waiting.data()), first(line.first.data()),
        edges(line.edges.data()) {}

  double *gap, *closing, *time, *due, *lag, *bound, *fraction, *reduced, *struck, *struck_mass;
  std::size_t inner_first, inner;
  std::uint32_t *candidates, *waiting, *first, *edges;
  std::size_t count = 0, later = 0, firsts = 0, at_edges = 0;  // in these lists
};

// Lists all gaps that are due up to `end`, from the tiles that may have some; renews the bounds of these.
HWY_INLINE void scan(StepLine& line, Local& l, double end) {
  const Lanes d;
  std::uint32_t* tiles = l.waiting;
  const auto last = hn::Set(d, end), never = hn::Set(d, StepLine::never);
  std::size_t visited = 0;
  for (std::size_t k = 0, all = line.tiles(); k < all; k += lanes)
    append(hn::Le(hn::LoadU(d, l.bound + k), last), k, tiles, visited);
  for (std::size_t v = 0; v < visited; ++v) {
    const std::size_t from = StepLine::tile * tiles[v];
    line.guard(tiles[v]);
    auto later = never;
    for (std::size_t k = from; k < from + StepLine::tile; k += lanes) {
      const auto due = hn::Load(d, l.due + k);
      const auto now = hn::Le(due, last);
      later = hn::Min(later, hn::IfThenElse(now, never, due));
      append(now, k, l.candidates, l.count);
    }
    l.bound[tiles[v]] = hn::GetLane(hn::MinOfLanes(d, later));
  }
}

// Whether a gap is due before its neighbours, 7 on the left and 8 on the right.
HWY_INLINE bool is_first(const double* due) {
  if (planted(1)) return true;
  const Lanes d;
  const auto own = hn::Set(d, *due);
  std::size_t no_later = 0;
  for (std::size_t k = 0; k < 8; k += lanes)
    no_later += hn::CountTrue(d, hn::Le(hn::LoadU(d, due - 7 + k), own)) +
                hn::CountTrue(d, hn::Le(hn::LoadU(d, due + 1 + k), own));
  return no_later == 1;
}

// Which of the candidates are first in their neighbourhoods, and which must wait.
HWY_INLINE void decide(Local& l, double end) {
  l.firsts = l.at_edges = l.later = 0;
  for (std::size_t k = 0; k < l.count; ++k) {
    const std::size_t i = l.candidates[k];
    const bool is_due = l.due[i] <= end, now = is_due & is_first(l.due + i);
    l.waiting[l.later] = static_cast<std::uint32_t>(i);
    l.later += is_due & !now;
    if (i - l.inner_first >= l.inner) [[unlikely]] {
      if (now) l.edges[l.at_edges++] = static_cast<std::uint32_t>(i);
      continue;
    }
    l.first[l.firsts] = static_cast<std::uint32_t>(i);
    l.firsts += now;
  }
}

// A neighbour of a collision has a new time of collision: it is a candidate if it is due now and was not before.
HWY_INLINE void renew(Local& l, double end, std::size_t i, double due_before, double due_now) {
  double& bound = l.bound[i / StepLine::tile];
  if (!planted(4)) bound = bound < due_now ? bound : due_now;
  l.waiting[l.later] = static_cast<std::uint32_t>(i);
  l.later += (due_now <= end) & (due_before > end);
}

// Numbers for the gaps left, at, and right of a collision, and for the next one, which does not change.
struct Four {
  alignas(32) double of[4];
  HWY_INLINE auto from(std::size_t k) const { return hn::Load(Few(), of + k); }
};

// The gap right of a collision, in a vector of all four or of the last ones.
HWY_INLINE double third(hn::Vec<Few> last) {
#if HWY_MAX_BYTES >= 32
  return hn::GetLane(hn::UpperHalf(hn::Half<Few>(), last));
#else
  return hn::GetLane(last);
#endif
}

// The task's numbers, read before anything is stored.
struct Constants {
  explicit HWY_INLINE Constants(const StepTask& task)
      : cutoff(hn::Set(Few(), task.cutoff)), half_sum(hn::Set(Few(), task.half_sum)),
        restitution(hn::Set(Few(), task.restitution)), floor{task.floor, -StepLine::never, task.floor,
                                                             -StepLine::never} {}
  hn::Vec<Few> cutoff, half_sum, restitution;
  Four floor;
};

// What is known of all collisions of a step.
struct Made {
  hn::Mask<Few> wrong;        // out of order, or for the event loop
  hn::Vec<Few> latest;        // time
  hn::Vec<Lanes> lost, rest;  // for the ledger
  std::uint64_t below_cutoff = 0;
};

struct Dues {
  double left, right;
};

// Makes the collision at the gap i, number k of its pass: g -= w since, w += gain, and what follows. Returns when the
// gaps beside it are due now.
template <StepLaw law, bool unequal, bool lags>
HWY_INLINE Dues collide(const StepLine& line, const Local& l, const Constants& task, std::size_t i, std::size_t k,
                        Made& made) {
  constexpr double never = StepLine::never;
  const Few f;
  const Four is_side{1, 0, planted(3) ? 0. : 1., planted(3) ? 1. : 0.}, is_own{0, 1, 0, 0}, is_next{0, 0, 0, 1},
      of_left{-1, 0, 1, 0};
  const Four soon{0, 0x1p-40, 0, -never};
  const auto zero = hn::Zero(f), one = hn::Set(f, 1.);
  const auto x = hn::Set(f, l.due[i]), w = hn::Set(f, l.closing[i]);
  const double fraction = unequal ? l.fraction[i] : 0;
  if (law != StepLaw::any) l.struck[k] = l.closing[i];
  if (unequal) l.struck_mass[k] = l.reduced[i];
  made.latest = hn::Max(made.latest, x);
  Dues dues{never, never};
  for (std::size_t h = 0; h < 4; h += few) {
    const std::size_t at = i - 1 + h;
    const auto side = hn::Eq(is_side.from(h), one), own = hn::Eq(is_own.from(h), one),
               next = hn::Eq(is_next.from(h), one);
    const auto g = hn::LoadU(f, l.gap + at), u = hn::LoadU(f, l.closing + at), then = hn::LoadU(f, l.time + at),
               was_due = hn::LoadU(f, l.due + at);
    auto after = w, gain = w;
    if constexpr (law == StepLaw::any) {
      after = hn::Set(f, line.after[k]);
      gain = hn::IfThenElse(hn::Lt(of_left.from(h), zero), hn::Set(f, line.to_left[k]), hn::Set(f, line.to_right[k]));
    } else {
      const auto elastic = hn::Lt(w, task.cutoff);
      if constexpr (law == StepLaw::hard) {
        gain = hn::Mul(hn::IfThenElse(elastic, one, task.half_sum), w);
        after = hn::Sub(w, hn::Add(gain, gain));
      } else {
        after = hn::Neg(hn::Mul(hn::IfThenElse(elastic, one, task.restitution), w));
        gain = hn::Mul(hn::Sub(w, after), hn::Set(f, 0.5));
      }
      if constexpr (unequal) {
        const auto handed = hn::Add(gain, gain), share = hn::Set(f, fraction);
        const auto small = hn::Mul(handed, hn::Abs(share)), large = hn::Sub(handed, small);
        gain = hn::IfThenElse(hn::Gt(hn::Mul(share, of_left.from(h)), zero), large, small);
      }
    }
    auto since = hn::Sub(x, then);
    if constexpr (lags) since = hn::Sub(since, hn::LoadU(f, l.lag + at));
    made.wrong = hn::Or(made.wrong, hn::Le(since, hn::Mul(x, soon.from(h))));
    const auto g_now = hn::Sub(g, hn::Mul(u, since)), u_now = hn::Add(u, gain);
    made.wrong = hn::Or(made.wrong, hn::Lt(g_now, task.floor.from(h)));
    const auto due_now =
        hn::IfThenElse(hn::And(side, hn::Gt(u_now, zero)), hn::Add(x, hn::Div(g_now, u_now)), hn::Set(f, never));
    // What was just stored takes a while to be loaded in another width: dues come from the vector.
    if (h == 0) dues.left = hn::GetLane(due_now);
    if (h == (few > 2 ? 0 : 2)) dues.right = third(due_now);
    hn::StoreU(hn::IfThenElse(next, g, hn::IfThenElseZero(side, g_now)), f, l.gap + at);
    hn::StoreU(hn::IfThenElse(next, u, hn::IfThenElse(own, after, u_now)), f, l.closing + at);
    hn::StoreU(hn::IfThenElse(next, then, x), f, l.time + at);
    hn::StoreU(hn::IfThenElse(next, was_due, due_now), f, l.due + at);
    if constexpr (lags) hn::StoreU(hn::IfThenElseZero(next, hn::LoadU(f, l.lag + at)), f, l.lag + at);
  }
  return dues;
}

// Enters the collisions of a pass in the ledger (ledger.hpp), by their closing speeds in `struck`.
template <bool unequal> HWY_INLINE void enter(const Local& l, const StepTask& task, Made& made) {
  const Lanes d;
  hn::StoreU(hn::Zero(d), d, l.struck + l.firsts);
  if (unequal) hn::StoreU(hn::Zero(d), d, l.struck_mass + l.firsts);
  const auto cutoff = hn::Set(d, task.cutoff), share = hn::Set(d, task.lost), rounder = hn::Set(d, task.rounder),
             per_fine = hn::Set(d, task.per_fine), whole = hn::Set(d, 0x1.8p52);
  for (std::size_t k = 0; k < l.firsts; k += lanes) {
    const auto w = hn::LoadU(d, l.struck + k);
    const auto elastic = hn::Lt(w, cutoff);
    made.below_cutoff += hn::CountTrue(d, hn::And(elastic, hn::Gt(w, hn::Zero(d))));
    auto factor = hn::IfThenZeroElse(elastic, share);
    if (unequal) factor = hn::Mul(factor, hn::LoadU(d, l.struck_mass + k));
    const auto loss = hn::Mul(factor, hn::Mul(w, w));
    const auto coarse = hn::Sub(hn::Add(loss, rounder), rounder);
    made.lost = hn::Add(made.lost, coarse);
    const auto fine = hn::Mul(hn::Sub(loss, coarse), per_fine);
    made.rest = hn::Add(made.rest, hn::Sub(hn::Add(fine, whole), whole));  // rounded
  }
}

// A step (loop.hpp).
template <StepLaw law, bool unequal, bool lags>
int step(StepLine& line, const StepTask& task, StepScalars& scalars, double end, StepResult& result) {
  constexpr int most_passes = 24;
  static_assert(most_passes < StepLine::tile);  // StepLine::guard
  Local l(line);
  const Constants constants(task);
  Made made{hn::FirstN(Few(), 0), hn::Set(Few(), result.last), hn::Zero(Lanes()), hn::Zero(Lanes())};
  int passes = 0;
  for (scan(line, l, end); l.count > 0; ++passes, std::swap(l.candidates, l.waiting), l.count = l.later) {
    if (passes == most_passes || l.count > line.gaps()) return -1;
    decide(l, end);
    if (l.firsts + l.at_edges == 0 && l.later > 0) return -1;  // at the same time
    if (law == StepLaw::any) scalars.outcomes(l.first, l.firsts);
    for (std::size_t k = 0; k < l.firsts; ++k) {
      const std::size_t i = l.first[k];
      const Dues before{l.due[i - 1], l.due[i + 1]}, now = collide<law, unequal, lags>(line, l, constants, i, k, made);
      renew(l, end, i - 1, before.left, now.left);
      renew(l, end, i + 1, before.right, now.right);
    }
    for (std::size_t k = 0; k < l.at_edges; ++k) {
      const std::size_t i = l.edges[k];
      const Dues before{i > 0 ? l.due[i - 1] : 0, l.due[i + 1]};
      if (!scalars.collide(i)) return -1;
      if (i > 0) renew(l, end, i - 1, before.left, l.due[i - 1]);
      renew(l, end, i + 1, before.right, l.due[i + 1]);
    }
    if (law != StepLaw::any) enter<unequal>(l, task, made);
    result.collisions += l.firsts;
  }
  result.last = hn::GetLane(made.latest);
  result.lost += hn::GetLane(hn::SumOfLanes(Lanes(), made.lost));
  result.rest += hn::GetLane(hn::SumOfLanes(Lanes(), made.rest));
  result.below_cutoff += made.below_cutoff;
  return planted(2) || (hn::AllFalse(Few(), made.wrong) && result.last <= end) ? passes : -1;
}

std::size_t width() { return lanes; }

bool run(StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace, StepResult& result) {
  const auto run_by = [&]<StepLaw law, bool unequal>() {
    return run_steps(step<law, unequal, false>, step<law, unequal, true>, line, task, scalars, pace, result);
  };
  if (task.law == StepLaw::hard)
    return task.unequal ? run_by.template operator()<StepLaw::hard, true>()
                        : run_by.template operator()<StepLaw::hard, false>();
  if (task.law == StepLaw::soft)
    return task.unequal ? run_by.template operator()<StepLaw::soft, true>()
                        : run_by.template operator()<StepLaw::soft, false>();
  return run_by.template operator()<StepLaw::any, false>();
}

}  // namespace HWY_NAMESPACE
}  // namespace cradle
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cradle {

HWY_EXPORT(run);
HWY_EXPORT(width);

const std::vector<Steps>& all_steps() {
  static const std::vector<Steps> all = [] {
    std::vector<Steps> found;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      found.push_back({hwy::TargetName(target), &HWY_DYNAMIC_DISPATCH(run)});
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return found;
  }();
  return all;
}

const Steps* fastest_steps() {
  // Of two lanes they are slower.
  const std::vector<Steps>& all = all_steps();
  return !all.empty() && HWY_DYNAMIC_DISPATCH(width)() >= 4 ? &all.front() : nullptr;
}

}  // namespace cradle
#endif
