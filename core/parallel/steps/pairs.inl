// Collisions in double-double as vectors: a part of steps.cpp, which includes it once for each kind of vectors. Numbers
// are sums of two doubles in two vectors. Operations are those of precision/double_double.hpp one for one, so that
// their bits are the same. They need fused multiply-adds and vectors of four lanes at least.
//
// README.md (Double-double) has the keys by which gaps are decided.

#undef CRADLE_PAIRS
#define CRADLE_PAIRS (HWY_NATIVE_FMA && HWY_MAX_BYTES >= 32)
#if CRADLE_PAIRS

namespace cradle {
namespace HWY_NAMESPACE {

template <class D> struct Pair { hn::Vec<D> high, low; };
template <class D> HWY_INLINE Pair<D> load(D d, const double* high, const double* low) {
  return {hn::LoadU(d, high), hn::LoadU(d, low)};
}
template <class D> HWY_INLINE void store(const Pair<D>& x, D d, double* high, double* low) {
  hn::StoreU(x.high, d, high), hn::StoreU(x.low, d, low);
}
template <class D> HWY_INLINE Pair<D> set(D d, double high, double low) { return {hn::Set(d, high), hn::Set(d, low)}; }
template <class D> HWY_INLINE Pair<D> select(hn::Mask<D> mask, const Pair<D>& yes, const Pair<D>& no) {
  return {hn::IfThenElse(mask, yes.high, no.high), hn::IfThenElse(mask, yes.low, no.low)};
}
template <class D> HWY_INLINE hn::Mask<D> less(const Pair<D>& x, const Pair<D>& y) {
  return hn::Or(hn::Lt(x.high, y.high), hn::And(hn::Eq(x.high, y.high), hn::Lt(x.low, y.low)));
}
template <class D> HWY_INLINE Pair<D> fast_two_sum(D, hn::Vec<D> a, hn::Vec<D> b) {
  const auto s = hn::Add(a, b);
  return {s, hn::Sub(b, hn::Sub(s, a))};
}
template <class D> HWY_INLINE Pair<D> two_sum(D, hn::Vec<D> a, hn::Vec<D> b) {
  const auto s = hn::Add(a, b), b_seen = hn::Sub(s, a);
  return {s, hn::Add(hn::Sub(a, hn::Sub(s, b_seen)), hn::Sub(b, b_seen))};
}
template <class D> HWY_INLINE Pair<D> negative(const Pair<D>& x) { return {hn::Neg(x.high), hn::Neg(x.low)}; }
template <class D> HWY_INLINE Pair<D> add(D d, const Pair<D>& x, const Pair<D>& y) {
  const auto s = two_sum(d, x.high, y.high), t = two_sum(d, x.low, y.low);
  const auto v = fast_two_sum(d, s.high, hn::Add(s.low, t.high));
  return fast_two_sum(d, v.high, hn::Add(t.low, v.low));
}
template <class D> HWY_INLINE Pair<D> subtract(D d, const Pair<D>& x, const Pair<D>& y) {
  return add(d, x, negative(y));
}
template <class D> HWY_INLINE Pair<D> multiply(D d, const Pair<D>& x, const Pair<D>& y) {
  const auto product = hn::Mul(x.high, y.high), error = hn::MulSub(x.high, y.high, product);
  const auto cross = hn::MulAdd(x.low, y.high, hn::MulAdd(x.high, y.low, hn::Mul(x.low, y.low)));
  return fast_two_sum(d, product, hn::Add(error, cross));
}
template <class D> HWY_INLINE Pair<D> divide(D d, const Pair<D>& x, const Pair<D>& y) {
  const auto quotient = hn::Div(x.high, y.high), product = hn::Mul(y.high, quotient);
  const auto r = fast_two_sum(d, product, hn::MulAdd(y.low, quotient, hn::MulSub(y.high, quotient, product)));
  const auto remainder = hn::Add(hn::Sub(x.high, r.high), hn::Sub(x.low, r.low));
  return fast_two_sum(d, quotient, hn::Div(remainder, y.high));
}

using Few = hn::CappedTag<double, 4>;
constexpr std::size_t few = hn::MaxLanes(Few());

// The collisions of a step, where numbers are sums of two doubles.
template <StepLaw law, bool unequal> struct Pairs {
  static constexpr bool linked = false;
  Pair<Few> latest;       // times of the last ones
  hn::Mask<Few> orderly;  // all of them came after the last ones at their gaps, and are not for the event loop
  hn::Vec<Few> floor;
  std::uint64_t below_cutoff = 0;
  bool soon = false;  // after the last one at its own gap, to the digits of a double: the origin may have to move

  HWY_INLINE Pairs(const StepTask& task, const StepResult& before)
      : latest(set(Few(), before.last, before.low_last)), orderly(hn::FirstN(Few(), few)),
        floor(hn::Set(Few(), task.floor)) {}

  HWY_INLINE void make(StepLine& line, Local& l, const StepTask& task, StepScalars&, double end) {
    outcomes(line, l, task);
    // There are two loops, since each operation waits for the one before: the shorter a turn is, the more of them are
    // in the processor at once.
    for (std::size_t k = 0; k < l.firsts; k += 2) fly(line, l, k);
    for (std::size_t k = 0; k < l.firsts; k += 2) foresee(line, l, end, k);
  }
  HWY_INLINE bool report(const StepTask&, double end, StepResult& result) const {
    double last[few], low_last[few];
    store(latest, Few(), last, low_last);
    for (std::size_t k = 0; k < few; ++k)
      if (result.last < last[k] || (result.last == last[k] && result.low_last < low_last[k]))
        result.last = last[k], result.low_last = low_last[k];
    result.below_cutoff += below_cutoff;
    return hn::AllTrue(Few(), orderly) && !soon && result.last <= end;
  }

 private:
  // What comes of the collisions of a pass by their closing speeds: of as many at once as there are lanes. Enters what
  // is lost at each gap.
  HWY_INLINE void outcomes(StepLine& line, const Local& l, const StepTask& task) {
    const Lanes d;
    const StepLine::Halves &high = line.high, &low = line.low;
    const auto zero = set(d, 0, 0), one = set(d, 1, 0), cutoff = set(d, task.cutoff, task.low.cutoff),
               restitution = set(d, task.restitution, task.low.restitution),
               half_sum = set(d, task.half_sum, task.low.half_sum), lost = set(d, task.lost, task.low.lost);
    double *struck = line.struck.data(), *low_struck = line.low_struck.data();
    double *sums = line.work.data(), *low_sums = sums + l.firsts + lanes;
    for (std::size_t k = 0; k < l.firsts; ++k) {
      const std::size_t i = l.first[k];
      struck[k] = high.closing[i], low_struck[k] = low.closing[i];
      sums[k] = high.lost[i], low_sums[k] = low.lost[i];
    }
    store(zero, d, struck + l.firsts, low_struck + l.firsts);
    for (std::size_t k = 0; k < l.firsts; k += lanes) {
      const std::uint32_t* const first = l.first + k;
      const std::size_t count = HWY_MIN(lanes, l.firsts - k);
      const auto gather = [&](const double* array, const double* low_array) HWY_ATTR {
        alignas(64) double numbers[2 * lanes] = {};
        for (std::size_t j = 0; j < count; ++j) numbers[j] = array[first[j]], numbers[lanes + j] = low_array[first[j]];
        return load(d, numbers, numbers + lanes);
      };
      const auto w = load(d, struck + k, low_struck + k);
      const auto elastic = less(w, cutoff);
      below_cutoff += hn::CountTrue(d, hn::And(elastic, hn::Gt(w.high, zero.high)));
      auto after = w, half = w;
      if constexpr (law == StepLaw::hard) {
        half = multiply(d, select(elastic, one, half_sum), w);
        after = subtract(d, w, add(d, half, half));
      } else {
        after = negative(multiply(d, select(elastic, one, restitution), w));
        half = divide(d, subtract(d, w, after), set(d, 2, 0));
      }
      auto share_lost = select(elastic, zero, lost);
      auto to_left = half, to_right = half;
      if constexpr (unequal) {
        const auto fraction = gather(high.fraction, low.fraction);
        const auto left_lighter = hn::Lt(fraction.high, zero.high);
        const auto handed = add(d, half, half);
        const auto share = select(left_lighter, negative(fraction), fraction), rough = multiply(d, handed, share);
        const auto large = subtract(d, handed, rough);
        const auto small = select(less(share, set(d, 1. / 16, 0)), rough, subtract(d, handed, large));
        to_left = select(left_lighter, large, small), to_right = select(left_lighter, small, large);
        share_lost = multiply(d, share_lost, gather(high.reduced, low.reduced));
      }
      store(after, d, line.after.data() + k, line.low_after.data() + k);
      store(to_left, d, line.to_left.data() + k, line.low_to_left.data() + k);
      if constexpr (unequal) store(to_right, d, line.to_right.data() + k, line.low_to_right.data() + k);
      store(add(d, load(d, sums + k, low_sums + k), multiply(d, share_lost, multiply(d, w, w))), d, sums + k,
            low_sums + k);
    }
    for (std::size_t k = 0; k < l.firsts; ++k) high.lost[l.first[k]] = sums[k], low.lost[l.first[k]] = low_sums[k];
  }

  // Two collisions of a pass, number k and the next one; or one twice, where it is the last.
  struct Two {
    std::size_t k, n, i, j;  // numbers and gaps
    double* work;            // what is handed from one loop to the other
    HWY_INLINE Two(StepLine& line, const Local& l, std::size_t number)
        : k(number), n(HWY_MIN(number + 1, l.firsts - 1)), i(l.first[k]), j(l.first[n]),
          work(line.work.data() + 16 * number) {}
  };
  static HWY_INLINE hn::Vec<Few> both(double of_i, double of_j) {
    return hn::OddEven(hn::Set(Few(), of_j), hn::Set(Few(), of_i));
  }
  // Of the gaps beside them: left of i, left of j, right of i, right of j.
  static HWY_INLINE hn::Vec<Few> beside(const double* array, const Two& two) {
    const Few f;
    return hn::InterleaveLower(f, hn::LoadU(f, array + two.i - 1), hn::LoadU(f, array + two.j - 1));
  }
  // Puts such numbers back, and those of their own gaps; the gaps next to these stay as they are.
  static HWY_INLINE void put(double* array, const Two& two, hn::Vec<Few> sides, double own_i, double own_j) {
    const Few f;
    double *const at_i = array + two.i - 1, *const at_j = array + two.j - 1;
    const auto of_j = planted(3) ? sides : hn::Reverse2(f, sides);
    const auto now_i = hn::OddEven(hn::ConcatUpperLower(f, hn::LoadU(f, at_i), hn::Set(f, own_i)), sides);
    const auto now_j = hn::OddEven(hn::ConcatUpperLower(f, hn::LoadU(f, at_j), hn::Set(f, own_j)), of_j);
    hn::StoreU(now_i, f, at_i), hn::StoreU(now_j, f, at_j);
  }

  // Makes two collisions but for the times at which the gaps beside them are due now.
  HWY_INLINE void fly(StepLine& line, const Local& l, std::size_t k) {
    const Few f;
    const Two two(line, l, k);
    const StepLine::Halves &high = line.high, &low = line.low;
    const auto zero = hn::Zero(f);
    const double x_i = l.due[two.i], x_j = l.due[two.j], low_x_i = low.due[two.i], low_x_j = low.due[two.j];
    const Pair<Few> x{both(x_i, x_j), both(low_x_i, low_x_j)};
    const Pair<Few> then{beside(high.time, two), beside(low.time, two)};
    auto since = subtract(f, x, then);
    if (!hn::AllFalse(f, hn::Lt(then.high, zero))) [[unlikely]] {
      const Pair<Few> lag{beside(high.lag, two), beside(low.lag, two)};
      since = select(hn::Lt(then.high, zero), subtract(f, since, lag), since);
    }
    const Pair<Few> g{beside(high.gap, two), beside(low.gap, two)};
    const Pair<Few> u{beside(high.closing, two), beside(low.closing, two)};
    Pair<Few> gain{both(line.to_left[k], line.to_left[two.n]), both(line.low_to_left[k], line.low_to_left[two.n])};
    if constexpr (unequal) {
      gain.high = hn::ConcatUpperLower(f, both(line.to_right[k], line.to_right[two.n]), gain.high);
      gain.low = hn::ConcatUpperLower(f, both(line.low_to_right[k], line.low_to_right[two.n]), gain.low);
    }
    const auto g_now = subtract(f, g, multiply(f, u, since)), u_now = add(f, u, gain);
    store(x, f, two.work, two.work + 4);
    store(g_now, f, two.work + 8, two.work + 12);
    store(u_now, f, two.work + 16, two.work + 20);
    orderly = hn::And(orderly, hn::And(hn::Gt(since.high, zero), hn::Gt(g_now.high, floor)));
    soon |= !(x_i - high.time[two.i] > x_i * 0x1p-39) | !(x_j - high.time[two.j] > x_j * 0x1p-39);
    latest = select(less(latest, x), x, latest);
    put(high.gap, two, g_now.high, 0, 0), put(low.gap, two, g_now.low, 0, 0);
    put(high.closing, two, u_now.high, line.after[k], line.after[two.n]);
    put(low.closing, two, u_now.low, line.low_after[k], line.low_after[two.n]);
    put(high.time, two, x.high, x_i, x_j), put(low.time, two, x.low, low_x_i, low_x_j);
  }

  // When the gaps beside two collisions are due now.
  HWY_INLINE void foresee(StepLine& line, Local& l, double end, std::size_t k) {
    const Few f;
    const Two two(line, l, k);
    const StepLine::Halves& low = line.low;
    const auto x = load(f, two.work, two.work + 4), g = load(f, two.work + 8, two.work + 12),
               u = load(f, two.work + 16, two.work + 20);
    const auto due = select(hn::Gt(u.high, hn::Zero(f)), add(f, x, divide(f, g, u)), set(f, StepLine::never, 0));
    orderly = hn::And(orderly, hn::Ge(due.high, x.high));  // a quotient beyond the greatest number is not a number
    const unsigned soon =
        bits_of(f, hn::And(hn::Le(due.high, hn::Set(f, end)), hn::Gt(beside(l.due, two), hn::Set(f, end))));
    put(l.due, two, due.high, StepLine::never, StepLine::never), put(low.due, two, due.low, 0, 0);
    follow(l, two.i - 1, soon & 1, two.i + 1, soon >> 2 & 1);
    if (two.n != k) follow(l, two.j - 1, soon >> 1 & 1, two.j + 1, soon >> 3 & 1);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace cradle
#endif
