// When gaps to walls close, in every scalar type. Under gravity: a ball that bounces a thousand times, to the last bit;
// random gaps, against 100 digits. To shaken walls: random gaps, grazing ones among them, against formulas of their own
// in 100 digits, close never later than they do, and at the speed that they have then. (A column:
// shaken_walls_test.cpp.)
#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"
#include "cradle/tests/precision/shaking.hpp"

namespace cradle::test::wall_gaps_test {

using Reference = bin_float;
template <class T> Reference exact(const T& x) { return in_100_digits(x); }

// ---- under gravity

template <class T> std::vector<T> bounces(const T& acceleration, const T& height, std::size_t count, const T& until) {
  const Scene<T> ball =
      std::make_shared<Walled<T>>(list<T>({height}, {T(0)}), Wall<T>{T(0)}, std::nullopt, T(-acceleration));
  auto run = mass_run(ball, Inelastic<T>(T(1)));
  std::vector<T> times;
  EXPECT_EQ(run.advance(until, [&](const Collision<T>& c) { times.push_back(c.time.value()); }), Status::reached);
  EXPECT_EQ(times.size(), count);
  EXPECT_EQ(run.energy_lost(), T(0));
  return times;
}

PRECISION_SUITE(FallIn, EveryPrecision);

// From the height k^2 with the acceleration 2 a ball is on the floor at the times k (2 n - 1). With k of less than half
// the digits of the type every number on the way can be exact.
PRECISION_TEST(FallIn, ABallBouncesAThousandTimesToTheLastBit) {
  const T epsilon = std::numeric_limits<T>::epsilon();
  T k(1);
  while (k * k * k * k * T(81) * T(1 << 24) * epsilon < T(1) && k < T(std::int64_t{1} << 60)) k *= T(3);
  ASSERT_GT(k, T(1));
  const std::vector<T> times = bounces<T>(T(2), T(k * k), 1000, T(T(2000) * k));
  for (std::size_t n = 0; n < times.size(); ++n) {
    const T exact = k * T(2 * static_cast<std::int64_t>(n) + 1);
    if constexpr (RoundsToNearest<T>)
      ASSERT_EQ(times[n], exact) << n;
    else  // double-double: one root, one quotient and their sums
      ASSERT_LE(magnitude(T(times[n] - exact)), T(8) * epsilon * exact) << n;
  }
}

struct Met {
  Reference in, speed;
};
std::optional<Met> by_digits(const Reference& g, const Reference& w, const Reference& p) {
  const Reference square = w * w + 2 * p * g;
  if (!(square > 0) || (p < 0 && !(w > 0))) return {};
  const Reference speed = sqrt(square);
  return Met{(speed - w) / p, speed};
}

template <class T> class WallGapsIn : public testing::Test {};
TYPED_TEST_SUITE(WallGapsIn, FixedTypes);

// Random gaps, among them such that only just reach the ceiling or do not. Errors in units u of half an epsilon: the
// speed has that of its square (u/2 after the root) and one of the root; the time twice that, less for the Newton step,
// and those of a sum and a quotient.
template <class T> void expect_right_meetings(int count) {
  const T epsilon = std::numeric_limits<T>::epsilon(), split = splitter<T>();
  const T tolerance = RoundsToNearest<T> ? T(T(5) * epsilon / T(2)) : T(T(64) * epsilon);
  std::int64_t draws = 0;
  const auto draw = [&] {  // from 2^-24 to 2^24, either sign
    const std::uint64_t bits = hash(draws++), more = hash(draws++);
    T value = (T(static_cast<std::int64_t>(bits >> 2)) * T(std::int64_t{1} << 50) + T(std::int64_t(more >> 14))) /
              T(std::int64_t{1} << 62);
    for (std::uint64_t k = more & 0x3F; k > 0; --k) value /= T(2);
    return bits & 1 ? T(-value) : value;
  };
  std::uint64_t met = 0, grazed = 0, missed = 0;
  for (int k = 0; k < count; ++k) {
    const T w = draw(), p = draw();
    T g = magnitude(draw());
    const bool near = k % 2 == 0 && p < T(0) && w > T(0);
    if (near) {
      g = w * w / (T(-2) * p);
      g += g * epsilon * T(k % 14 - 7);
    }
    if (!(g > T(0)) || p == T(0)) continue;
    const Approach<T> approach(g, w, p, split);
    const auto meeting = approach.meeting();
    const auto wanted = by_digits(exact(g), exact(w), exact(p));
    if (near && !RoundsToNearest<T>) continue;
    ASSERT_EQ(meeting.has_value(), wanted.has_value()) << k;
    if (!meeting) {
      ++missed;
      continue;
    }
    ++(near ? grazed : met);
    ASSERT_LE(abs(exact(meeting->in) - wanted->in), exact(tolerance) * wanted->in) << k;
    ASSERT_LE(abs(exact(meeting->speed) - wanted->speed), exact(tolerance) * wanted->speed) << k;
  }
  EXPECT_GT(met, static_cast<std::uint64_t>(count) / 2);
  EXPECT_GT(missed, static_cast<std::uint64_t>(count) / 10);
  if (RoundsToNearest<T>) {
    EXPECT_GT(grazed, static_cast<std::uint64_t>(count) / 50);
  }
}
TYPED_TEST(WallGapsIn, RandomGapsCloseWhenTheyDo) { expect_right_meetings<TypeParam>(4000); }
TYPED_TEST(WallGapsIn, SlowManyRandomGapsCloseWhenTheyDo) { expect_right_meetings<TypeParam>(100000); }

// The times of a thousand bounces from a height that is not exact, against sqrt(2 h/a) (2 n - 1): the first fall and
// the time between bounces have errors of 3 u at most, and so have all sums of them, but for one rounding.
TYPED_TEST(WallGapsIn, AThousandBouncesKeepTheirTimes) {
  using T = TypeParam;
  for (int k = 1; k < 8; ++k) {
    const T h = T(10 * k) / T(7), a = T(k + 3) / T(9);
    const Reference first = sqrt(2 * exact(h) / exact(a));
    const auto times = bounces<T>(a, h, 1000, exactly<T>(static_cast<double>(2000 * first)));
    const Reference tolerance = exact(T(T(RoundsToNearest<T> ? 2 : 16) * T(std::numeric_limits<T>::epsilon())));
    for (std::size_t n = 0; n < times.size(); ++n) {
      const Reference wanted = first * (2 * n + 1);
      ASSERT_LE(abs(exact(times[n]) - wanted), tolerance * wanted) << n;
    }
  }
}

// ---- to shaken walls

// A gap by numbers of the type N, double or the reference: value and first two derivatives.
template <class N> struct Curve {
  Shaking<N> wall;
  N gap, closing, pull, since;

  N turns(const N& t) const { return wall.turns(since + t); }
  N at(const N& t) const {
    const N start = turns(N(0));
    return gap - (closing - wall.speed(start)) * t - pull * t * t / 2 - (wall.place(turns(t)) - wall.place(start));
  }
  N rate(const N& t) const { return -(closing - wall.speed(turns(N(0)))) - pull * t - wall.speed(turns(t)); }
  N bend(const N& t) const { return -pull - wall.acceleration(turns(t)); }
};

// The times of the local minima of a gap until `end`, in double: between two samples, and on teeth at their tips.
std::vector<double> minima(const Curve<double>& c, double end) {
  const double period = c.wall.period(), step = period / 48;
  std::vector<double> found;
  if (c.wall.shape == Shape::sawtooth) {
    for (double t = (0.5 - c.turns(0)) * period; t < end; t += period) found.push_back(t);
    return found;
  }
  for (double low = 0; low < end; low += step) {
    double from = low, to = std::min(end, low + step);
    if (!(c.rate(from) < 0 && c.rate(to) > 0)) continue;
    for (int k = 0; k < 40; ++k) (c.rate((from + to) / 2) < 0 ? from : to) = (from + to) / 2;
    found.push_back((from + to) / 2);
  }
  return found;
}
// The same in 100 digits, by Newton's steps; at the tip of a tooth the time of the jump.
Reference sharpened(const Curve<Reference>& c, double minimum) {
  Reference t(minimum);
  if (c.wall.shape == Shape::sawtooth) {
    Reference y = c.turns(t);
    if (y > 0) y -= 1;
    return t - (y + Reference(0.5)) * c.wall.period();
  }
  for (int k = 0; k < 4; ++k)
    if (const Reference bend = c.bend(t); bend > 0) t -= c.rate(t) / bend;
  return t;
}
Reference at_minimum(const Curve<Reference>& c, const Reference& t) {
  if (c.wall.shape != Shape::sawtooth) return c.at(t);
  return c.at(t) - (c.turns(t) < 0 ? 2 * c.wall.amplitude : Reference(0));  // just before the jump
}

class Draws {
 public:
  double operator()() { return static_cast<double>(hash(count_++) >> 11) * 0x1p-53; }
  double octaves(double low, double high) { return std::exp2(low + (high - low) * (*this)()); }

 private:
  std::int64_t count_ = 0;
};

// No minimum before the time found is below zero, and there the gap is zero and closes at the speed found: by at most
// 64 roundings (512 in double-double, whose operations have errors of several units), in units u of the sizes that are
// added up and of the time of the phase. A third of the gaps is moved so that it touches zero within a few roundings,
// or 1e-9 of its size.
template <class T> void expect_never_late(int count) {
  Draws draw;
  const Reference u = exact(T(std::numeric_limits<T>::epsilon())) / 2;
  std::uint64_t met = 0, never = 0, grazing = 0, grazed = 0;
  for (int k = 0; k < count; ++k) {
    const auto shape = static_cast<Shape>(k % 3);
    const double amplitude = draw.octaves(-6, 2), frequency = draw.octaves(-2, 4), phase = 12 * draw() - 6;
    Curve<double> c{{shape, amplitude, frequency, phase}, 0, 0, 0, 100 * draw()};
    const double speed = amplitude * frequency, period = c.wall.period();
    c.pull = draw() < 0.25 ? 0 : 2 * (draw() - 0.4) * speed * frequency * (draw() < 0.1 ? 0.01 : 1);
    c.closing = (4 * draw() - 2) * speed;
    c.gap = draw() < 0.3 ? 0 : amplitude * draw.octaves(-6, 2);
    if (c.gap == 0) c.closing = -std::abs(c.closing);
    Curve<Reference> wide{{shape, amplitude, frequency, phase}, c.gap, c.closing, c.pull, c.since};
    T gap = exactly<T>(c.gap);
    const bool graze = k % 9 > 5;
    if (graze) {
      std::optional<Reference> deepest;
      for (const double t : minima(c, 4 * period)) {
        const Reference here = at_minimum(wide, sharpened(wide, t));
        if (!deepest || here < *deepest) deepest = here;
      }
      if (!deepest || !(wide.gap > *deepest)) continue;
      const double off = (draw() - 0.5) * (draw() < 0.5 ? 16 * static_cast<double>(u) : 1e-9);
      gap = from_text<T>(to_text(Reference((wide.gap - *deepest) * (1 + Reference(off)))));
      wide.gap = exact(gap), c.gap = to_double(gap);
      ++grazing;
    }
    const WallMotion<T> motion(shape, exactly<T>(amplitude), exactly<T>(frequency), exactly<T>(phase));
    const ShakenApproach<T> approach(gap, exactly<T>(c.closing), exactly<T>(c.pull), splitter<T>(), motion,
                                     motion.moment({exactly<T>(c.since), T(0)}));
    const auto meeting = approach.meeting();
    const Reference end = meeting ? exact(meeting->in) : Reference(40 * period);
    const Reference sizes = wide.gap + amplitude + (abs(wide.closing) + speed) * end + abs(wide.pull) * end * end / 2;
    const Reference at_end = abs(wide.closing) + speed + abs(wide.pull) * end;
    const Reference tolerance = (RoundsToNearest<T> ? 64 : 512) * u * (sizes + at_end * (c.since + end));
    if (meeting) {
      ++met;
      grazed += graze;
      ASSERT_GE(meeting->speed, T(0)) << k;
      ASSERT_LE(abs(wide.at(end)), tolerance) << k << ' ' << static_cast<double>(end);
      const Reference then = exact(meeting->speed), bend = abs(wide.pull) + speed * frequency;
      if (then * then > 1000 * bend * tolerance) {  // not a touch that rounding decides
        ASSERT_LE(abs(then + wide.rate(end)), (RoundsToNearest<T> ? 64 : 512) * u * (at_end + bend * (c.since + end)))
            << k << ' ' << static_cast<double>(then);
      }
    } else {
      ++never;
    }
    for (const double t : minima(c, static_cast<double>(end) * (1 - 1e-12))) {
      if (c.at(t) > 1e-6 * static_cast<double>(sizes)) continue;
      const Reference exactly_then = sharpened(wide, t);
      if (exactly_then < end) {
        ASSERT_GE(at_minimum(wide, exactly_then), -tolerance) << k << " skipped at " << t;
      }
    }
  }
  EXPECT_GT(met, static_cast<std::uint64_t>(count) / 3);
  EXPECT_GT(never, static_cast<std::uint64_t>(count) / 10);
  EXPECT_GT(grazing, static_cast<std::uint64_t>(count) / 12);
  EXPECT_GT(grazed, grazing / 4);
  EXPECT_LT(grazed, grazing);
}

TYPED_TEST(WallGapsIn, NoCollisionWithAShakenWallIsSkipped) { expect_never_late<TypeParam>(2000); }
TYPED_TEST(WallGapsIn, SlowNoneOfManyWithAShakenWallIsSkipped) { expect_never_late<TypeParam>(100000); }

}  // namespace cradle::test::wall_gaps_test
