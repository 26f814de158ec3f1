// Gravity in every scalar type: a ball that bounces a thousand times, to the last bit; when random gaps to walls close,
// against 100 digits. (A column: shaken_walls_test.cpp.)
#include <gtest/gtest.h>

#include <vector>

#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::gravity_in_types_test {

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

template <class P> class FallIn : public InPrecision<P> {};
TYPED_TEST_SUITE(FallIn, EveryPrecision, PrecisionName);

// From the height k^2 with the acceleration 2 a ball is on the floor at the times k (2 n - 1). With k of less than half
// the digits of the type every number on the way can be exact.
TYPED_TEST(FallIn, ABallBouncesAThousandTimesToTheLastBit) {
  using T = typename TypeParam::Scalar;
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

using Reference = bin_float;
template <class T> Reference exact(const T& x) { return in_100_digits(x); }

struct ByDigits {
  bool meets;
  Reference time, speed;
};
ByDigits by_digits(const Reference& g, const Reference& w, const Reference& p) {
  const Reference square = w * w + 2 * p * g;
  if (!(square > 0) || (p < 0 && !(w > 0))) return {false, {}, {}};
  const Reference speed = sqrt(square);
  return {true, (speed - w) / p, speed};
}

template <class T> class ApproachIn : public testing::Test {};
TYPED_TEST_SUITE(ApproachIn, FixedTypes);

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
    const ByDigits wanted = by_digits(exact(g), exact(w), exact(p));
    if (near && !RoundsToNearest<T>) continue;
    ASSERT_EQ(meeting.has_value(), wanted.meets) << k;
    if (!meeting) {
      ++missed;
      continue;
    }
    ++(near ? grazed : met);
    ASSERT_LE(abs(exact(meeting->in) - wanted.time), exact(tolerance) * wanted.time) << k;
    ASSERT_LE(abs(exact(meeting->speed) - wanted.speed), exact(tolerance) * wanted.speed) << k;
  }
  EXPECT_GT(met, static_cast<std::uint64_t>(count) / 2);
  EXPECT_GT(missed, static_cast<std::uint64_t>(count) / 10);
  if (RoundsToNearest<T>) {
    EXPECT_GT(grazed, static_cast<std::uint64_t>(count) / 50);
  }
}
TYPED_TEST(ApproachIn, RandomGapsCloseWhenTheyDo) { expect_right_meetings<TypeParam>(4000); }
TYPED_TEST(ApproachIn, SlowManyRandomGapsCloseWhenTheyDo) { expect_right_meetings<TypeParam>(100000); }

// The times of a thousand bounces from a height that is not exact, against sqrt(2 h/a) (2 n - 1): the first fall and
// the time between bounces have errors of 3 u at most, and so have all sums of them, but for one rounding.
TYPED_TEST(ApproachIn, AThousandBouncesKeepTheirTimes) {
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

}  // namespace cradle::test::gravity_in_types_test
