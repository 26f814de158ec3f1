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

// The collisions of a step.
struct WetCollisions {
  static constexpr bool linked = true;
  static constexpr std::ptrdiff_t width = sizeof(Cell<double>) / sizeof(double);
  Totals made;
  Four parting = all(-StepLine::never);  // greatest closing speed after passing, which must not be positive
  std::uint64_t passed = 0;

  HWY_INLINE WetCollisions(const StepTask&, const StepResult& before) : made{.latest = all(before.last)} {}

  // Makes those that are first in a pass, and lists those that merge with the collisions at edges.
  HWY_INLINE void make(StepLine& line, Local& l, const StepTask& task, StepScalars&, double end) {
    fill_up(line, l, false);
    std::size_t pairs = 0;
    for (std::size_t k = 0; k < l.firsts; k += 4) pairs += collide(l, task, k, end);
    l.firsts = pairs;
    passed += pairs;
  }
  // Returns how many have passed through each other.
  HWY_INLINE std::size_t collide(Local& l, const StepTask& task, std::size_t k, double end) {
    const Places4<width> places(l, l.first + k);
    const Cells own = Cells::at(places, 0), left = Cells::at(places, -1), right = Cells::at(places, 1);
    TwoThere a[4], b[4];
    Four beyond;
    for (int j = 0; j < 4; ++j) {
      a[j] = *particle_in(places.cell[j]), b[j] = *particle_in(places.cell[j] + width);
      beyond[j] = places.cell[j][2 * width + 3];
    }
    const Four m = Four{a[0][0], a[1][0], a[2][0], a[3][0]}, n = Four{b[0][0], b[1][0], b[2][0], b[3][0]};
    const Four x = own.due, w = own.closing - right.closing, total = m + n, product = m * n, scaled = w * w * product;
    const Four critical = root(task.twice_loss * (total / product));
    const Four pass = scaled < task.below * total   ? all(0)
                      : scaled > task.above * total ? all(1)
                      : w > critical                ? all(1)
                                                    : all(0);
    const Four after = root((w - critical) * (w + critical)), impulse = task.twice_loss / (w + after);
    const Four slowed = own.closing - impulse / m, sped = right.closing + impulse / n;
    const unsigned valid = l.firsts - k < 4 ? (1U << (l.firsts - k)) - 1 : 15, passes = ~bits_up_to(pass, 0) & 15;

    Four since_left = x - left.time, since_right = x - right.time;
    if (bits_up_to(least(left.time, right.time), 0) != 0) [[unlikely]] {
      since_left -= left.time < 0 ? places.of(l.lag - 1) : all(0);
      since_right -= right.time < 0 ? places.of(l.lag + 1) : all(0);
    }
    const auto kicked = [&](const Cells& before, const Four& so_far, const Four& since, const Four& speed,
                            const Four& closing) {
      Cells now;
      now.gap = before.gap - so_far * since;
      now.time = x, now.closing = speed;
      now.due = closing > 0 ? x + now.gap / closing : all(StepLine::never);
      made.flown = least(since, made.flown);
      made.gap = least(now.gap, made.gap);
      return now;
    };
    Cells now{all(0), x, all(StepLine::never), sped};
    Cells now_left = kicked(left, left.closing - own.closing, since_left, left.closing, left.closing - sped),
          now_right = kicked(right, right.closing - beyond, since_right, slowed, slowed - beyond);
    made.own_flown = least(x - own.time, made.own_flown);
    made.latest = x > made.latest ? x : made.latest;
    const Four apart = sped - slowed;
    if (passes == 15) {
      parting = apart > parting ? apart : parting;
    } else {
      parting = choose(pass, apart, all(-1)) > parting ? choose(pass, apart, all(-1)) : parting;
      const auto only_passing = [&](Cells& cells, const Cells& before) {
        cells.gap = choose(pass, cells.gap, before.gap), cells.time = choose(pass, cells.time, before.time);
        cells.due = choose(pass, cells.due, before.due), cells.closing = choose(pass, cells.closing, before.closing);
      };
      only_passing(now, own), only_passing(now_left, left), only_passing(now_right, right);
      leave_to_scalars(~passes & valid, l, l.first + k);
    }
    now.put_at(places, 0, l.due), now_left.put_at(places, -1, l.due), now_right.put_at(places, 1, l.due);
    for (int j = 0; j < 4; ++j)
      if (passes >> j & 1) *particle_in(places.cell[j]) = b[j], *particle_in(places.cell[j] + width) = a[j];
    follow(l, l.first + k, bits_up_to(now_left.due, end) & ~bits_up_to(left.due, end) & valid & passes,
           bits_up_to(now_right.due, end) & ~bits_up_to(right.due, end) & valid & passes, valid & passes);
    return static_cast<std::size_t>(__builtin_popcount(passes & valid));
  }
  // Those of four that are set.
  static HWY_INLINE void leave_to_scalars(unsigned set, Local& l, const std::uint32_t* four) {
    for (unsigned j = 0; j < 4; ++j) {
      l.edges[l.at_edges] = four[j];
      l.at_edges += set >> j & 1;
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
