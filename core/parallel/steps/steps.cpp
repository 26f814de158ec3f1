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
constexpr std::size_t lanes = hn::MaxLanes(Lanes());

// Times of collision are compared eight at a time.
constexpr std::size_t group = 8;
using Group = hn::CappedTag<std::uint32_t, group>;

// The places of a byte's bits, one after the other: Highway's own Compress copies a large table each time.
struct Places {
  alignas(64) std::uint32_t of[256][group] = {};
  constexpr Places() {
    for (unsigned bits = 0; bits < 256; ++bits)
      for (unsigned k = 0, n = 0; k < group; ++k)
        if (bits >> k & 1) of[bits][n++] = k;
  }
};
constexpr Places places;

template <class D> HWY_INLINE unsigned bits_of(D d, hn::Mask<D> mask) {
  std::uint8_t bits[8];
  hn::StoreMaskBits(d, mask, bits);
  return bits[0] & ((1U << hn::MaxLanes(d)) - 1);
}

// Appends the numbers of a group's gaps that are set, counted from `base`, to a list.
HWY_INLINE void append(unsigned set, std::size_t base, std::uint32_t* list, std::size_t& length) {
  const Group d;
  for (std::size_t k = 0; k < group; k += hn::MaxLanes(d))
    hn::StoreU(hn::Add(hn::LoadU(d, places.of[set] + k), hn::Set(d, static_cast<std::uint32_t>(base))), d,
               list + length + k);
  length += static_cast<std::size_t>(__builtin_popcount(set));
}

// The arrays and lists of a line, where the compiler keeps them in registers.
struct Local {
  explicit HWY_INLINE Local(StepLine& line)
      : cells(line.cells), lag(line.lag), due(line.due), bound(line.bound), fraction(line.fraction),
        reduced(line.reduced), struck(line.struck.data()), struck_mass(line.struck_mass.data()),
        inner_first(line.inner_first), inner(line.inner), candidates(line.candidates.data()),
        waiting(line.waiting.data()), first(line.first.data()), edges(line.edges.data()), visited(line.visited.data()) {
  }

  Gap<double>* cells;
  const double* lag;
  double *due, *bound, *fraction, *reduced, *struck, *struck_mass;
  std::size_t inner_first, inner;
  std::uint32_t *candidates, *waiting, *first, *edges, *visited;
  std::size_t count = 0, later = 0, firsts = 0, at_edges = 0, visits = 0;  // in these lists
};

// Which of a group are due up to `last`.
HWY_INLINE unsigned due_of_group(const double* due, hn::Vec<Lanes> last) {
  const Lanes d;
  unsigned set = 0;
  for (std::size_t k = 0; k < group; k += lanes) set |= bits_of(d, hn::Le(hn::Load(d, due + k), last)) << k;
  return set;
}

// Lists all gaps that are due up to `end`, and the tiles that have some.
HWY_INLINE void scan(StepLine& line, Local& l, double end) {
  const auto last = hn::Set(Lanes(), end);
  for (std::size_t k = 0, all = line.tiles(); k < all; k += group)
    append(due_of_group(l.bound + k, last), k, l.visited, l.visits);
  for (std::size_t v = 0; v < l.visits; ++v) {
    line.guard(l.visited[v]);
    const std::size_t from = StepLine::tile * l.visited[v];
    for (std::size_t k = from; k < from + StepLine::tile; k += group)
      append(due_of_group(l.due + k, last), k, l.candidates, l.count);
  }
}

// The bounds of the tiles in which collisions were made, or beside them.
HWY_INLINE void renew_bounds(const Local& l) {
  const Lanes d;
  if (planted(4)) return;
  for (std::size_t v = 0; v < l.visits; ++v) {
    const double* due = l.due + StepLine::tile * l.visited[v];
    auto least = hn::Load(d, due);
    for (std::size_t k = lanes; k < StepLine::tile; k += lanes) least = hn::Min(least, hn::Load(d, due + k));
    l.bound[l.visited[v]] = hn::GetLane(hn::MinOfLanes(d, least));
  }
}

// Whether a gap is due before its neighbours, eight on either side.
HWY_INLINE bool is_first(const double* due) {
  if (planted(1)) return true;
  const Lanes d;
  auto least = hn::Min(hn::LoadU(d, due - group), hn::LoadU(d, due + 1));
  for (std::size_t k = lanes; k < group; k += lanes)
    least = hn::Min(least, hn::Min(hn::LoadU(d, due - group + k), hn::LoadU(d, due + 1 + k)));
  return hn::AllTrue(d, hn::Lt(hn::Set(d, *due), least));
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

// The gaps beside a collision may lie in other tiles, and they are candidates if they are due now and were not before.
HWY_INLINE void follow(Local& l, std::size_t left, unsigned left_soon, std::size_t right, unsigned right_soon) {
  const std::size_t left_tile = left / StepLine::tile, right_tile = right / StepLine::tile;
  l.visited[l.visits] = static_cast<std::uint32_t>(left_tile);
  l.visited[l.visits + 1] = static_cast<std::uint32_t>(right_tile);
  l.visits += left_tile != right_tile ? 2 : 0;
  l.waiting[l.later] = static_cast<std::uint32_t>(left);
  l.later += left_soon;
  l.waiting[l.later] = static_cast<std::uint32_t>(right);
  l.later += right_soon;
}

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
    if constexpr (law == StepLaw::hard) {
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

// The collisions of a step, where numbers are doubles.
template <StepLaw law, bool unequal> struct Doubles {
  Made made;

  HWY_INLINE Doubles(const StepTask&, const StepResult& before) : made{.latest = before.last} {}

  // Makes those that are first in a pass. In two loops: the shorter a turn, the more of them are in the processor at
  // once, and each operation waits for the one before (1.2 times as fast as one loop).
  HWY_INLINE void make(StepLine& line, Local& l, const StepTask& task, StepScalars& scalars, double end) {
    if (law == StepLaw::any) scalars.outcomes(l.first, l.firsts);
    for (std::size_t k = 0; k < l.firsts; ++k) collide<law, unequal>(line, l, task, l.first[k], k, made);
    for (std::size_t k = 0; k < l.firsts; ++k) foresee(l, end, l.first[k]);
    if (law != StepLaw::any) enter<unequal>(l, task, made);
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

#include "cradle/core/parallel/steps/pairs.inl"

namespace cradle {
namespace HWY_NAMESPACE {

// A step (loop.hpp).
template <class Collisions>
int step(StepLine& line, const StepTask& task, StepScalars& scalars, double end, StepResult& result) {
  constexpr int most_passes = 128, reach = StepLine::tile - 1;  // StepLine::guard
  Local l(line);
  Collisions collisions(task, result);
  int passes = 0;
  for (scan(line, l, end); l.count > 0; ++passes, std::swap(l.candidates, l.waiting), l.count = l.later) {
    if (passes == most_passes || std::max(l.count, l.visits) > line.gaps()) return -1;
    if (passes % reach == reach - 1) [[unlikely]]
      for (std::size_t k = 0; k < l.count; ++k) line.guard(l.candidates[k] / StepLine::tile);
    decide(l, end);
    if (l.firsts + l.at_edges == 0 && l.later > 0) return -1;  // at the same time
    collisions.make(line, l, task, scalars, end);
    for (std::size_t k = 0; k < l.at_edges; ++k) {
      const std::size_t i = l.edges[k], left = i > 0 ? i - 1 : 0, right = i + 1;
      const bool left_later = l.due[left] > end, right_later = l.due[right] > end;
      if (!scalars.collide(i)) return -1;
      follow(l, left, left_later & (l.due[left] <= end), right, right_later & (l.due[right] <= end));
    }
    result.collisions += l.firsts;
  }
  renew_bounds(l);
  return collisions.report(task, end, result) || planted(2) ? passes : -1;
}

std::size_t width() { return lanes; }

template <template <StepLaw law, bool unequal> class Collisions, class... Arguments>
bool run_by(const StepTask& task, StepLine& line, Arguments&... arguments) {
  constexpr StepLaw hard = StepLaw::hard, soft = StepLaw::soft;
  if (task.law == hard)
    return task.unequal ? run_steps(step<Collisions<hard, true>>, line, task, arguments...)
                        : run_steps(step<Collisions<hard, false>>, line, task, arguments...);
  return task.unequal ? run_steps(step<Collisions<soft, true>>, line, task, arguments...)
                      : run_steps(step<Collisions<soft, false>>, line, task, arguments...);
}
bool run(StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace, StepResult& result) {
#if CRADLE_PAIRS
  if (task.pairs) return run_by<Pairs>(task, line, scalars, pace, result);
#endif
  if (task.pairs) return false;
  if (task.law == StepLaw::any) return run_steps(step<Doubles<StepLaw::any, false>>, line, task, scalars, pace, result);
  return run_by<Doubles>(task, line, scalars, pace, result);
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
