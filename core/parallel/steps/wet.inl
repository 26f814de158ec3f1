// Wet collisions in double: a part of steps.cpp, as doubles.inl. Particles pass through each other here, four pairs at
// a time; those that merge are left to StepScalars, with all collisions near a vacant cell. Operations are those of Wet
// and of ClusterLine::strike, one for one.

namespace cradle {
namespace HWY_NAMESPACE {

// Mass and number of a particle, which lie side by side in its cell.
typedef double TwoThere __attribute__((vector_size(16), may_alias, aligned(8)));
HWY_INLINE TwoThere* particle_in(double* cell) { return reinterpret_cast<TwoThere*>(cell + 4); }

HWY_INLINE Four root(const Four& x) {
  const hn::CappedTag<double, 4> d;
  alignas(32) double lanes_of[4];
  put(x, lanes_of);
  for (std::size_t k = 0; k < 4; k += hn::MaxLanes(d)) hn::Store(hn::Sqrt(hn::Load(d, lanes_of + k)), d, lanes_of + k);
  return fetch(lanes_of);
}
// Those lanes of `x` for which `pass` is set, else those of `y`.
HWY_INLINE Four choose(const Four& pass, const Four& x, const Four& y) { return pass > 0 ? x : y; }

// Four cells, and the ones beside them.
struct Cells4 {
  static constexpr std::size_t width = sizeof(Cell<double>) / sizeof(double);
  std::size_t i[4];
  double* cell[4];

  HWY_INLINE Cells4(const Local& l, const std::uint32_t* four) {
    for (int k = 0; k < 4; ++k) i[k] = four[k], cell[k] = l.numbers + width * i[k];
  }
  HWY_INLINE Cells4(const Cells4& from, std::ptrdiff_t side) {
    for (int k = 0; k < 4; ++k)
      i[k] = from.i[k] + static_cast<std::size_t>(side),
      cell[k] = from.cell[k] + static_cast<std::ptrdiff_t>(width) * side;
  }
  HWY_INLINE Cells4(const StepLine& line, const Cells4& from, Slot Cell<double>::*link) {
    for (int k = 0; k < 4; ++k) {
      i[k] = line.clusters[from.i[k]].*link - line.slot_of_first;
      cell[k] = line.numbers + width * i[k];
    }
  }
  HWY_INLINE Four of(const double* array) const { return Four{array[i[0]], array[i[1]], array[i[2]], array[i[3]]}; }
  HWY_INLINE Four number(std::size_t k) const { return Four{cell[0][k], cell[1][k], cell[2][k], cell[3][k]}; }
  HWY_INLINE Cells get() const { return Cells::at(cell[0], cell[1], cell[2], cell[3]); }
  HWY_INLINE void set(const Cells& cells, double* due) const {
    cells.put_at(cell[0], cell[1], cell[2], cell[3]);
    for (int k = 0; k < 4; ++k) due[i[k]] = cells.due[planted(3) ? 0 : k];
  }
};

// The collisions of a step.
struct WetCollisions {
  static constexpr bool linked = true;
  Totals made;
  Four parting = all(-StepLine::never);  // greatest closing speed after passing, which must not be positive
  std::uint64_t passed = 0;

  HWY_INLINE WetCollisions(const StepTask&, const StepResult& before) : made{.latest = all(before.last)} {}

  // Makes those that are first in a pass, and lists those that merge with the collisions at edges.
  HWY_INLINE void make(StepLine& line, Local& l, const StepTask& task, StepScalars&, double end) {
    l.firsts = make<false>(line, l, task, l.first, l.firsts, end);
    l.by_links = make<true>(line, l, task, l.first_by_links, l.by_links, end);
    passed += l.firsts + l.by_links;
  }
  template <bool linked_cells>
  HWY_INLINE std::size_t make(StepLine& line, Local& l, const StepTask& task, std::uint32_t* first, std::size_t count,
                              double end) {
    std::size_t pairs = 0;
    fill_up(first, count);
    for (std::size_t k = 0; k < count; k += 4)
      pairs += collide<linked_cells>(line, l, task, first + k, std::min<std::size_t>(count - k, 4), end);
    return pairs;
  }
  // Returns how many have passed through each other, of so many.
  template <bool linked_cells>
  HWY_INLINE std::size_t collide(StepLine& line, Local& l, const StepTask& task, const std::uint32_t* four,
                                 std::size_t count, double end) {
    const Cells4 here(l, four);
    if constexpr (linked_cells) {
      const Cells4 on_left(line, here, &Cell<double>::left), on_right(line, here, &Cell<double>::right);
      const Cells4 beyond(line, on_right, &Cell<double>::right);
      return collide<linked_cells>(line, l, task, four, count, end, here, on_left, on_right, beyond);
    } else {
      return collide<linked_cells>(line, l, task, four, count, end, here, Cells4(here, -1), Cells4(here, 1),
                                   Cells4(here, 2));
    }
  }
  template <bool linked_cells>
  HWY_INLINE std::size_t collide(StepLine& line, Local& l, const StepTask& task, const std::uint32_t* four,
                                 std::size_t count, double end, const Cells4& here, const Cells4& on_left,
                                 const Cells4& on_right, const Cells4& beyond) {
    const Cells own = here.get(), left = on_left.get(), right = on_right.get();
    const Four speed_beyond = beyond.number(3), m = here.number(4), n = on_right.number(4);
    const Four x = own.due, w = own.closing - right.closing, total = m + n, product = m * n, scaled = w * w * product;
    const Four critical = root(task.twice_loss * (total / product));
    const Four pass = scaled < task.below * total   ? all(0)
                      : scaled > task.above * total ? all(1)
                      : w > critical                ? all(1)
                                                    : all(0);
    const Four after = root((w - critical) * (w + critical)), impulse = task.twice_loss / (w + after);
    const Four slowed = own.closing - impulse / m, sped = right.closing + impulse / n;
    const unsigned valid = (1U << count) - 1, passes = ~bits_up_to(pass, 0) & 15;

    Four since_left = x - left.time, since_right = x - right.time;
    if (bits_up_to(least(left.time, right.time), 0) != 0) [[unlikely]] {
      since_left -= left.time < 0 ? on_left.of(l.lag) : all(0);
      since_right -= right.time < 0 ? on_right.of(l.lag) : all(0);
    }
    Cells now{all(0), x, all(StepLine::never), sped};
    Cells now_left = kick(left, left.closing - own.closing, since_left, x, left.closing, left.closing - sped, made),
          now_right = kick(right, right.closing - speed_beyond, since_right, x, slowed, slowed - speed_beyond, made);
    made.own_flown = least(x - own.time, made.own_flown);
    made.latest = x > made.latest ? x : made.latest;
    Four apart = sped - slowed;
    if (passes != 15) {
      const auto only_passing = [&](Cells& cells, const Cells& before) {
        cells.gap = choose(pass, cells.gap, before.gap), cells.time = choose(pass, cells.time, before.time);
        cells.due = choose(pass, cells.due, before.due), cells.closing = choose(pass, cells.closing, before.closing);
      };
      apart = choose(pass, apart, all(-1));
      only_passing(now, own), only_passing(now_left, left), only_passing(now_right, right);
      leave_to_scalars(~passes & valid, l, four);
    }
    parting = apart > parting ? apart : parting;
    if constexpr (linked_cells) visit(line, l, here, on_left), visit(line, l, here, on_right);
    here.set(now, l.due), on_left.set(now_left, l.due), on_right.set(now_right, l.due);
    swap_particles(here, on_right, passes);
    const unsigned left_soon = bits_up_to(now_left.due, end) & ~bits_up_to(left.due, end) & valid & passes,
                   right_soon = bits_up_to(now_right.due, end) & ~bits_up_to(right.due, end) & valid & passes;
    if constexpr (linked_cells)
      wait(l, on_left, left_soon), wait(l, on_right, right_soon);
    else
      follow(l, four, left_soon, right_soon, valid & passes);
    return static_cast<std::size_t>(__builtin_popcount(passes & valid));
  }
  // The tiles of neighbours, where they are others: by links they may be far away.
  static HWY_INLINE void visit(StepLine& line, Local& l, const Cells4& own, const Cells4& beside) {
    for (int k = 0; k < 4; ++k) {
      const std::size_t there = beside.i[k] / StepLine::tile;
      if (there == own.i[k] / StepLine::tile) continue;
      line.guard(there);
      l.visited[l.visits++] = static_cast<std::uint32_t>(there);
    }
  }
  static HWY_INLINE void wait(Local& l, const Cells4& cells, unsigned soon) {
    for (int k = 0; k < 4; ++k) {
      l.waiting[l.later] = static_cast<std::uint32_t>(cells.i[k]);
      l.later += soon >> k & 1;
    }
  }
  static HWY_INLINE void swap_particles(const Cells4& a, const Cells4& b, unsigned which) {
    TwoThere of_a[4], of_b[4];
    for (int k = 0; k < 4; ++k) of_a[k] = *particle_in(a.cell[k]), of_b[k] = *particle_in(b.cell[k]);
    for (int k = 0; k < 4; ++k)
      if (which >> k & 1) *particle_in(a.cell[k]) = of_b[k], *particle_in(b.cell[k]) = of_a[k];
  }
  // Those of four that are set.
  static HWY_INLINE void leave_to_scalars(unsigned set, Local& l, const std::uint32_t* four) {
    for (unsigned k = 0; k < 4; ++k) {
      l.edges[l.at_edges] = four[k];
      l.at_edges += set >> k & 1;
    }
  }

  // Whether all of them were in order.
  HWY_INLINE bool report(const StepTask& task, double end, StepResult& result) const {
    result.last = std::max(std::max(made.latest[0], made.latest[1]), std::max(made.latest[2], made.latest[3]));
    const double coarse = (task.lost + task.rounder) - task.rounder, whole = 0x1.8p52;
    result.lost += static_cast<double>(passed) * coarse;
    result.rest += static_cast<double>(passed) * ((task.lost - coarse) * task.per_fine + whole - whole);
    return made.in_order(task.floor, end) && !(-least(-parting) > 0);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace cradle
