// Time as origin and offset. Proves: moving the origin any number of times changes nothing. (That a run which starts at
// 1e12, where a double resolves only 1e-4, has bit for bit the gaps and closing speeds of a run that starts at 0, and
// collision times that differ by 1e12, in a collapse too, is in tests/precision/precision_runs_test.cpp.)
#include <random>

#include "cradle/core/queue/clock.hpp"
#include "cradle/tests/core/digits.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test::clock_test {

using Wide = Digits<100>;

constexpr double start = 1e12;

Wide exactly(const Pair<double>& time) { return Wide(time.high) + Wide(time.low); }

TEST(Clock, SumsAMillionMovesToTheSquareOfItsPrecision) {
  std::mt19937_64 random(1);
  Clock<double> clock(start);
  Wide exact = start;
  for (int move = 0; move < 1000000; ++move) {
    const double by = std::ldexp(static_cast<double>(random() >> 11), -60);
    clock.move_origin(by);
    exact += Wide(by);
  }
  // Each addition to the pair rounds at 2^-105 of 1e12.
  EXPECT_LE(abs(exactly(clock.stamp(0)) - exact), Wide(1e6) * Wide(start) * Wide(std::ldexp(1, -105)));
  EXPECT_NEAR(clock.elapsed(0), static_cast<double>(exact - Wide(start)),
              static_cast<double>(exact - Wide(start)) * 2 * std::numeric_limits<double>::epsilon());
}

// What an offset loses when the origin moves is kept beside it: a gap that nobody touches is as exact after a hundred
// thousand moves as after none, its collision comes when it should.
TEST(Clock, MovesLeaveNoTraceInAGapThatNobodyTouches) {
  std::mt19937_64 random(2);
  GapChain<double> chain(list<double>({0, 1000, 3000}, {1, 0, 0}), 0);
  const Slot s = chain.first();
  Wide moved = 0;
  for (int move = 0; move < 100000; ++move) {
    const double by = std::ldexp(static_cast<double>(random() >> 11), -60);  // 53 bits, up to 2^-7
    chain.move_origin(by);
    moved += Wide(by);
  }
  const double exact = static_cast<double>(1000 - moved), rounding = 1000 * std::numeric_limits<double>::epsilon();
  EXPECT_NEAR(chain.gap_at(s, 0), exact, 2 * rounding);  // of the way flown and of the difference
  EXPECT_NEAR(chain.due(s), exact, 2 * rounding);
  EXPECT_EQ(chain.gap_at(s + 1, 0), 2000);
}

TEST(Clock, OffsetsAndTimesAreInverse) {
  Clock<double> clock(6500);
  clock.move_origin(1e-9);
  clock.move_origin(1e-12);
  EXPECT_EQ(clock.start(), 6500);
  EXPECT_EQ(clock.offset(6500), -1e-9 - 1e-12);
  EXPECT_EQ(clock.offset(clock.time(0.5)), clock.time(0.5) - 6500 - (1e-9 + 1e-12));
  EXPECT_NEAR(clock.elapsed(0), 1e-9 + 1e-12, 1e-24);
  EXPECT_NEAR(clock.elapsed(1e-15), 1e-9 + 1e-12 + 1e-15, 1e-24);
}

}  // namespace cradle::test::clock_test
