// A step on vectors. Google Highway compiles this file once for each kind of vectors and takes the widest ones that the
// processor has; no other file knows it.

// Vectors of two doubles are slower than the event loop (fastest_steps): they are not compiled, but where a processor
// has no others.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cradle/core/parallel/steps/steps.cpp"
#include <hwy/foreach_target.h>  // before highway.h
#include <hwy/highway.h>

#include "cradle/core/base/planted_error.hpp"
#include "cradle/core/parallel/steps/steps.hpp"

HWY_BEFORE_NAMESPACE();
namespace cradle {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Errors that are planted: no radius, no check, a mask of the wrong lane, no bounds of tiles, collisions left out that
// a step leaves to the next.
using cradle::planted;

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
      : cells(line.cells), numbers(line.numbers), lag(line.lag), due(line.due), bound(line.bound),
        fraction(line.fraction), reduced(line.reduced), struck(line.struck.data()),
        struck_mass(line.struck_mass.data()), inner_first(line.inner_first), inner_count(line.inner_count),
        around(line.ring ? line.gaps() : 0), special(line.special.data()), candidates(line.candidates.data()),
        waiting(line.waiting.data()), first(line.first.data()), first_by_links(line.first_by_links.data()),
        edges(line.edges.data()), visited(line.visited.data()) {}

  Gap<double>* cells;
  double* numbers;
  const double* lag;
  double *due, *bound, *fraction, *reduced, *struck, *struck_mass;
  std::size_t inner_first, inner_count, around;  // around: gaps of a ring, else 0
  const StepLine::Special* special;
  std::uint32_t *candidates, *waiting, *first, *first_by_links, *edges, *visited;
  std::size_t count = 0, later = 0, firsts = 0, by_links = 0, at_edges = 0, visits = 0;  // in these lists
};

// Which of a group are due after `from` and up to `last`.
HWY_INLINE unsigned due_of_group(const double* due, hn::Vec<Lanes> from, hn::Vec<Lanes> last) {
  const Lanes d;
  unsigned set = 0;
  for (std::size_t k = 0; k < group; k += lanes) {
    const auto times = hn::Load(d, due + k);
    set |= bits_of(d, hn::And(hn::Le(times, last), hn::Gt(times, from))) << k;
  }
  return set;
}

// Lists all gaps that are due up to `end` and not listed yet, and the tiles that have some.
HWY_INLINE void scan(StepLine& line, Local& l, double end) {
  const auto last = hn::Set(Lanes(), end), listed = hn::Set(Lanes(), line.listed_to);
  for (std::size_t k = 0, all = line.tiles(); k < all; k += group)
    append(due_of_group(l.bound + k, hn::Set(Lanes(), -StepLine::never), last), k, l.visited, l.visits);
  for (std::size_t v = 0; v < l.visits; ++v) {
    line.guard(l.visited[v]);
    const std::size_t from = StepLine::tile * l.visited[v];
    for (std::size_t k = from; k < from + StepLine::tile; k += group)
      append(due_of_group(l.due + k, listed, last), k, l.candidates, l.count);
  }
}

// Leaves what is still due up to `end` to the next step, if few collisions are left over from so many: passes with few
// collisions are dear. None is left twice, or the dense parts of the line would fall behind.
HWY_INLINE bool leave(StepLine& line, Local& l, double end, std::size_t made) {
  constexpr std::size_t few = 16;
  if (few * l.later > made) return false;
  for (std::size_t k = 0; k < l.later; ++k)
    if (l.due[l.waiting[k]] <= line.listed_to) return false;
  std::size_t left = 0;
  for (std::size_t k = 0; k < l.later; ++k) {
    l.waiting[left] = l.waiting[k];
    left += l.due[l.waiting[k]] <= end;
  }
  std::copy_n(l.waiting, left, line.candidates.data());
  line.left = planted(5) ? 0 : left;
  return true;
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

}  // namespace HWY_NAMESPACE
}  // namespace cradle

#include "cradle/core/parallel/steps/decisions.inl"
#include "cradle/core/parallel/steps/doubles.inl"
#include "cradle/core/parallel/steps/pairs.inl"
#include "cradle/core/parallel/steps/wet.inl"

namespace cradle {
namespace HWY_NAMESPACE {

// A step (steps.hpp).
template <class Collisions>
int step(StepLine& line, const StepTask& task, StepScalars& scalars, double end, StepResult& result) {
  constexpr int most_passes = 128, reach = StepLine::tile - 1;  // StepLine::guard
  Local l(line);
  Collisions collisions(task, result);
  const std::uint64_t before = result.collisions;
  int passes = 0;
  l.count = std::exchange(line.left, 0);
  for (scan(line, l, end); l.count > 0; std::swap(l.candidates, l.waiting), l.count = l.later) {
    if (passes == most_passes || std::max(l.count, l.visits) > line.gaps()) return -1;
    if (passes++ % reach == reach - 1) [[unlikely]]
      for (std::size_t k = 0; k < l.count; ++k) line.guard(l.candidates[k] / StepLine::tile);
    decide<Collisions::linked>(line, l, end);
    if (l.firsts + l.by_links + l.at_edges == 0 && l.later > 0) return -1;  // at the same time
    collisions.make(line, l, task, scalars, end);
    for (std::size_t k = 0; k < l.at_edges; ++k) {
      const std::size_t i = l.edges[k];
      const auto [left, right] =
          Collisions::linked ? line.guarded_by_links(i) : std::pair(line.left_of(i), line.right_of(i));
      const bool left_later = l.due[left] > end, right_later = l.due[right] > end;
      if (!scalars.collide(i)) return -1;
      follow(l, left, left_later & (l.due[left] <= end), right, right_later & (l.due[right] <= end));
      // A particle may fall back on a wall; the gap behind a particle that has merged is in this place now.
      l.waiting[l.later] = static_cast<std::uint32_t>(i);
      l.later += l.due[i] <= end;
    }
    result.collisions += l.firsts + l.by_links;
    if (line.may_leave && end < task.stop && leave(line, l, end, result.collisions - before)) break;
  }
  passes += line.left > 0;  // what is left takes at least one more
  line.listed_to = end;
  renew_bounds(l);
  return collisions.report(task, end, result) || planted(2) ? passes : -1;
}

std::size_t width() { return lanes; }

template <template <StepLaw law, bool unequal> class Collisions, StepLaw law> Steps::Step by(const StepTask& task) {
  return task.unequal ? step<Collisions<law, true>> : step<Collisions<law, false>>;
}
template <template <StepLaw law, bool unequal> class Collisions> Steps::Step by(const StepTask& task) {
  return task.law == StepLaw::hard ? by<Collisions, StepLaw::hard>(task) : by<Collisions, StepLaw::soft>(task);
}
Steps::Step step_of(const StepTask& task) {
#if CRADLE_PAIRS
  if (task.pairs) return by<Pairs>(task);
#endif
  if (task.pairs) return nullptr;
  if (task.law == StepLaw::wet) return step<WetCollisions>;
  if (task.law == StepLaw::any) return step<Doubles<StepLaw::any, false>>;
  return task.law == StepLaw::of_speed ? by<Doubles, StepLaw::of_speed>(task) : by<Doubles>(task);
}
bool run(StepLine& line, const StepTask& task, StepScalars& scalars, StepPace& pace, StepResult& result) {
  const Steps::Step by_law = step_of(task);
  return by_law != nullptr && run_steps(by_law, line, task, scalars, pace, result);
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
