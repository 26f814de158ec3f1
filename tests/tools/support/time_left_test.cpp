// The time left of a run: exact where the cost of a unit of simulated time is constant or grows linearly, as in a dry
// shock; nothing while the pace changes in a way that says nothing of the rest.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "cradle/tools/support/progress.hpp"

namespace cradle::tests::time_left_test {

using tools::TimeLeft;

// After `seconds` of a run which needs cost(t) seconds for the time t, sampled every half second.
template <class Time> std::optional<double> left(double seconds, double end, const Time& time) {
  TimeLeft pace;
  for (double s = 0; s <= seconds; s += 0.5) pace.add(s, time(s));
  return pace.until(end);
}

TEST(TimeLeft, IsExactAtAConstantPace) {
  const auto found = left(10, 60, [](double s) { return 3 * s; });
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 10, 1e-9);  // the sums of a few roundings
}

// cost = t^2 / 100: all of it is 100 s for t = 100. The costs of two quarters and the linear continuation of their
// means are those of the parabola exactly where quarters end at samples. Roundings of 1e-15 are divided by differences
// of costs that are a tenth of them, a few times.
TEST(TimeLeft, IsExactWhereTheCostGrowsLinearly) {
  for (const double seconds : {36.0, 64.0, 80.0}) {
    const auto found = left(seconds, 100, [](double s) { return 10 * std::sqrt(s); });
    ASSERT_TRUE(found) << seconds;
    EXPECT_NEAR(*found, 100 - seconds, 1e-10) << seconds;
  }
}

// A shock at its collapse: 6500 of 9000 in one second, then slower and slower. Half of what would have been predicted
// after a second is over soon.
TEST(TimeLeft, IsNotGivenWhileItCannotBeKnown) {
  const auto collapse = [](double s) { return s < 1 ? 6500 * s : 6500 + 100 * std::log(s); };
  for (const double seconds : {2.0, 3.0, 5.0, 10.0, 20.0, 50.0}) {
    const auto found = left(seconds, 9000, collapse);
    EXPECT_FALSE(found) << seconds << ": " << *found;
  }
}

TEST(TimeLeft, IsNotGivenAtTheBeginningOrWithoutProgress) {
  EXPECT_FALSE(left(1.5, 60, [](double s) { return 3 * s; }));
  EXPECT_FALSE(left(20, 60, [](double) { return 1.0; }));
  EXPECT_FALSE(TimeLeft().until(1));
}

TEST(TimeLeft, IsPrintedWithItsUnits) {
  EXPECT_EQ(tools::duration(6.2), "6 s");
  EXPECT_EQ(tools::duration(200), "3 min 20 s");
  EXPECT_EQ(tools::duration(7500), "2 h 05 min");
}

// However long the run, few points are kept, and the answer stays.
TEST(TimeLeft, ThinsOutItsPoints) {
  TimeLeft pace;
  for (int k = 0; k <= 100'000; ++k) pace.add(0.2 * k, k);
  ASSERT_TRUE(pace.until(200'000));
  EXPECT_NEAR(*pace.until(200'000), 20'000, 1);
}

// A line a minute, every ten seconds on request, none if quiet.
TEST(ProgressLine, IsDueOnceAMinuteWhereThereIsNoTerminal) {
  const int before = ::dup(STDERR_FILENO), nowhere = ::open("/dev/null", O_WRONLY);
  ASSERT_EQ(::dup2(nowhere, STDERR_FILENO), STDERR_FILENO);
  using Show = tools::ProgressLine::Show;
  const auto due = [](Show show, int seconds) {
    const tools::ProgressLine line(show);
    return line.due(std::chrono::steady_clock::now() + std::chrono::seconds(seconds)).has_value();
  };
  EXPECT_FALSE(due(Show::on_terminal, 59));
  EXPECT_TRUE(due(Show::on_terminal, 60));
  EXPECT_FALSE(due(Show::always, 9));
  EXPECT_TRUE(due(Show::always, 10));
  EXPECT_FALSE(due(Show::never, 3600));
  ::dup2(before, STDERR_FILENO);
  ::close(before), ::close(nowhere);
}

}  // namespace cradle::tests::time_left_test
