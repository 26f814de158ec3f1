// Collisions in double: a part of steps.cpp, which includes it once for each kind of vectors. The operations are those
// of the event loop one for one, so that their bits are the same.

#include "cradle/core/parallel/steps/restitution.inl"

namespace cradle {
namespace HWY_NAMESPACE {

// Numbers of four collisions, one in each lane, on any processor; and as they lie in memory, four of an array or those
// of a gap. Functions of them are inlined, so that it does not matter how such arguments are passed.
#pragma GCC diagnostic ignored "-Wpsabi"
typedef double Four __attribute__((vector_size(32)));
typedef double FourThere __attribute__((vector_size(32), may_alias, aligned(8)));
HWY_INLINE Four fetch(const double* from) { return *reinterpret_cast<const FourThere*>(from); }
HWY_INLINE void put(const Four& x, double* to) { *reinterpret_cast<FourThere*>(to) = x; }
HWY_INLINE Four all(double x) { return Four{x, x, x, x}; }
HWY_INLINE Four least(const Four& a, const Four& b) { return a < b ? a : b; }
HWY_INLINE double least(const Four& a) { return std::min(std::min(a[0], a[1]), std::min(a[2], a[3])); }
// Which of them are at most `last`.
HWY_INLINE unsigned bits_up_to(const Four& x, double last) {
  const hn::CappedTag<double, 4> d;
  alignas(32) double lanes_of[4];
  put(x, lanes_of);
  unsigned bits = 0;
  for (std::size_t k = 0; k < 4; k += hn::MaxLanes(d))
    bits |= bits_of(d, hn::Le(hn::Load(d, lanes_of + k), hn::Set(d, last))) << k;
  return bits;
}

// Where the gaps of four collisions are.
struct Places4 {
  std::size_t i[4];
  double* cell[4];
  HWY_INLINE Places4(const Local& l, const std::uint32_t* four) {
    for (int k = 0; k < 4; ++k) i[k] = four[k], cell[k] = l.numbers + 4 * i[k];
  }
  HWY_INLINE Four of(const double* array) const { return Four{array[i[0]], array[i[1]], array[i[2]], array[i[3]]}; }
};

// Four gaps: those of the collisions (side 0), or the ones left (-1) or right of them. A gap lies in memory as gap,
// local time, time of collision and closing speed (of clusters the particle's velocity); here it is a column.
struct Cells {
  Four gap, time, due, closing;

  static HWY_INLINE Cells at(const Places4& places, std::ptrdiff_t side) {
    double* const* cell = places.cell;
    return at(cell[0] + 4 * side, cell[1] + 4 * side, cell[2] + 4 * side, cell[3] + 4 * side);
  }
  static HWY_INLINE Cells at(const double* first, const double* second, const double* third, const double* fourth) {
    const Four a = fetch(first), b = fetch(second), c = fetch(third), d = fetch(fourth);
    const Four ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
               more_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7), more_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(more_ab, more_cd, 0, 1, 4, 5),
            __builtin_shufflevector(ab, cd, 2, 3, 6, 7), __builtin_shufflevector(more_ab, more_cd, 2, 3, 6, 7)};
  }
  HWY_INLINE void put_at(const Places4& places, std::ptrdiff_t side, double* due_there) const {
    double* const* cell = places.cell;
    put_at(cell[0] + 4 * side, cell[1] + 4 * side, cell[2] + 4 * side, cell[3] + 4 * side);
    for (int k = 0; k < 4; ++k) due_there[places.i[k] + static_cast<std::size_t>(side)] = due[planted(3) ? 0 : k];
  }
  HWY_INLINE void put_at(double* first, double* second, double* third, double* fourth) const {
    const Four a = __builtin_shufflevector(gap, time, 0, 4, 2, 6), b = __builtin_shufflevector(gap, time, 1, 5, 3, 7),
               c = __builtin_shufflevector(due, closing, 0, 4, 2, 6),
               d = __builtin_shufflevector(due, closing, 1, 5, 3, 7);
    put(__builtin_shufflevector(a, c, 0, 1, 4, 5), first), put(__builtin_shufflevector(b, d, 0, 1, 4, 5), second);
    put(__builtin_shufflevector(a, c, 2, 3, 6, 7), third), put(__builtin_shufflevector(b, d, 2, 3, 6, 7), fourth);
  }
};
static_assert(sizeof(Gap<double>) == sizeof(Four) && sizeof(Cell<double>) == 2 * sizeof(Four));

// What is known of all collisions of a step.
struct Totals {
  Four flown = all(StepLine::never), own_flown = flown;  // least times since the collision before: beside, and own
  Four gap = flown;                                      // least gaps beside
  Four latest;
  hn::Vec<Lanes> lost = hn::Zero(Lanes()), rest = hn::Zero(Lanes());  // for the ledger
  std::uint64_t below_cutoff = 0;

  // Whether every collision came after the last ones at its gaps and left no gap below the floor.
  HWY_INLINE bool in_order(double floor, double end) const {
    return least(flown) > 0 && least(own_flown) > end * 0x1p-40 && least(gap) >= floor;
  }
};

// The gaps beside the collisions, which have closed at `so_far` since their local times: g -= so_far since, and due
// anew, since they close at `closing` now. `speed` is what their cells hold then.
HWY_INLINE Cells kick(const Cells& before, const Four& so_far, const Four& since, const Four& x, const Four& speed,
                      const Four& closing, Totals& made) {
  Cells now;
  now.gap = before.gap - so_far * since;
  now.time = x, now.closing = speed;
  now.due = closing > 0 ? x + now.gap / closing : all(StepLine::never);
  made.flown = least(since, made.flown);
  made.gap = least(now.gap, made.gap);
  return now;
}

using FourPlaces = hn::CappedTag<std::uint32_t, 4>;
// Appends those of four places that are set to a list.
HWY_INLINE void append(unsigned set, hn::Vec<FourPlaces> places_of, std::uint32_t* list, std::size_t& length) {
  const FourPlaces d;
  hn::StoreU(hn::TableLookupLanes(places_of, hn::IndicesFromVec(d, hn::LoadU(d, places.of[set]))), d, list + length);
  length += static_cast<std::size_t>(__builtin_popcount(set));
}
// As `follow`, for four collisions. Their own tiles have been visited, as those of all candidates.
HWY_INLINE void follow(Local& l, const std::uint32_t* four, unsigned left_soon, unsigned right_soon, unsigned valid) {
  static_assert(StepLine::tile == 16);
  const FourPlaces d;
  constexpr std::size_t at_once = hn::MaxLanes(d);
  for (std::size_t k = 0; k < 4; k += at_once, left_soon >>= at_once, right_soon >>= at_once, valid >>= at_once) {
    constexpr unsigned mask = (1U << at_once) - 1;
    const auto i = hn::LoadU(d, four + k), one = hn::Set(d, 1U), left = hn::Sub(i, one), right = hn::Add(i, one);
    append(left_soon & mask, left, l.waiting, l.later);
    append(right_soon & mask, right, l.waiting, l.later);
    const auto own = hn::ShiftRight<4>(i),
               beside = hn::Sub(hn::Add(hn::ShiftRight<4>(left), hn::ShiftRight<4>(right)), own);
    append(bits_of(d, hn::Ne(beside, own)) & valid & mask, beside, l.visited, l.visits);
  }
}

// Repeats the last collision of a pass, so that there are four to the end.
HWY_INLINE void fill_up(std::uint32_t* first, std::size_t count) {
  for (std::size_t k = count; k > 0 && k < count + 3; ++k) first[k] = first[k - 1];
}
HWY_INLINE void fill_up(StepLine& line, const Local& l, bool with_outcomes) {
  fill_up(l.first, l.firsts);
  if (!with_outcomes) return;
  for (std::size_t k = l.firsts; k > 0 && k < l.firsts + 3; ++k)
    line.after[k] = line.after[k - 1], line.to_left[k] = line.to_left[k - 1], line.to_right[k] = line.to_right[k - 1];
}

// Makes four collisions of a pass from number k on; the last ones may be one and the same. They are so far apart that
// they touch different gaps, and all gaps are read before any is written.
template <StepLaw law, bool unequal>
HWY_INLINE void collide(const StepLine& line, Local& l, const StepTask& task, std::size_t k, double end, Totals& made) {
  const Places4 places(l, l.first + k);
  const Cells own = Cells::at(places, 0), left = Cells::at(places, -1), right = Cells::at(places, 1);
  const Four x = own.due, w = own.closing;
  Four after, to_left, to_right;
  if constexpr (law == StepLaw::any) {
    after = fetch(line.after.data() + k), to_left = fetch(line.to_left.data() + k),
    to_right = fetch(line.to_right.data() + k);
  } else {
    if constexpr (law == StepLaw::of_speed) {
      after = fetch(line.after.data() + k), to_left = fetch(line.to_left.data() + k);
    } else if constexpr (law == StepLaw::hard) {
      to_left = (w < task.cutoff ? all(1) : all(task.half_sum)) * w;
      after = w - (to_left + to_left);
    } else {
      after = -((w < task.cutoff ? all(1) : all(task.restitution)) * w);
      to_left = (w - after) * 0.5;
    }
    to_right = to_left;
    if constexpr (unequal) {
      const Four share = places.of(l.fraction), part = share < 0 ? -share : share, both = to_left + to_left,
                 rough = both * part, large = both - rough, small = part < 1. / 16 ? rough : both - large;
      to_left = share < 0 ? large : small, to_right = share < 0 ? small : large;
      put(places.of(l.reduced), l.struck_mass + k);
    }
    put(w, l.struck + k);
  }
  made.own_flown = least(x - own.time, made.own_flown);
  made.latest = x > made.latest ? x : made.latest;
  Four since_left = x - left.time, since_right = x - right.time;
  if (bits_up_to(least(left.time, right.time), 0) != 0) [[unlikely]] {
    since_left -= left.time < 0 ? places.of(l.lag - 1) : all(0);
    since_right -= right.time < 0 ? places.of(l.lag + 1) : all(0);
  }
  const Four left_closing = left.closing + to_left, right_closing = right.closing + to_right;
  const Cells now_left = kick(left, left.closing, since_left, x, left_closing, left_closing, made),
              now_right = kick(right, right.closing, since_right, x, right_closing, right_closing, made);
  Cells{all(0), x, all(StepLine::never), after}.put_at(places, 0, l.due);
  now_left.put_at(places, -1, l.due), now_right.put_at(places, 1, l.due);
  const unsigned valid = l.firsts - k < 4 ? (1U << (l.firsts - k)) - 1 : 15;
  follow(l, l.first + k, bits_up_to(now_left.due, end) & ~bits_up_to(left.due, end) & valid,
         bits_up_to(now_right.due, end) & ~bits_up_to(right.due, end) & valid, valid);
}

// Enters the collisions of a pass in the ledger (ledger.hpp), by their closing speeds in `struck`.
template <StepLaw law, bool unequal>
HWY_INLINE void enter(const StepLine& line, const Local& l, const StepTask& task, Totals& made) {
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
  static constexpr bool linked = false;
  Totals made;

  HWY_INLINE Doubles(const StepTask&, const StepResult& before) : made{.latest = all(before.last)} {}

  // Makes those that are first in a pass.
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
    fill_up(line, l, as == StepLaw::any || as == StepLaw::of_speed);
    for (std::size_t k = 0; k < l.firsts; k += 4) collide<as, masses_too>(line, l, task, k, end, made);
    if (as != StepLaw::any) enter<as, masses_too>(line, l, task, made);
  }
  // Whether all of them were in order.
  HWY_INLINE bool report(const StepTask& task, double end, StepResult& result) const {
    result.last = std::max(std::max(made.latest[0], made.latest[1]), std::max(made.latest[2], made.latest[3]));
    result.lost += hn::GetLane(hn::SumOfLanes(Lanes(), made.lost));
    result.rest += hn::GetLane(hn::SumOfLanes(Lanes(), made.rest));
    result.below_cutoff += made.below_cutoff;
    return made.in_order(task.floor, end);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace cradle
