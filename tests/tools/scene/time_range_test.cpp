// Ranges of times in place of lists: the decimals that a user would write, in every key that takes times, in files and
// on the command line. (Messages: tests/tools/messages.txt.)
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::time_range_test {

using Strings = std::vector<std::string>;
using cradle::test::Rational;

const std::string ring = "law = { type = 'sticky' }\ninitial = { type = 'ring', particles = 10 }\n[run]\nuntil = 100\n";

Scene parse(const std::string& output, const Strings& overrides = {}) {
  return parse_scene(ring + "[output]\n" + output, "s.toml", overrides);
}
Strings snapshots(const std::string& range, const Strings& overrides = {}) {
  Strings texts;
  for (const Decimal& time : parse("snapshots = " + range, overrides).output.snapshots) texts.push_back(time.text);
  return texts;
}
TEST(TimeRange, StepsAreTheDecimalsThatAUserWouldWrite) {
  EXPECT_EQ(snapshots("{ from = 70, until = 70.08, every = 0.02 }"),
            (Strings{"70", "70.02", "70.04", "70.06", "70.08"}));
  EXPECT_EQ(snapshots("{ from = 1, until = 2, every = 0.4 }"), (Strings{"1", "1.4", "1.8"}));
  EXPECT_EQ(snapshots("{ from = 5, until = 5, every = 1e300 }"), (Strings{"5"}));
  EXPECT_EQ(snapshots("{ from = '0.1', until = 0.3, every = 1e-1 }"), (Strings{"0.1", "0.2", "0.3"}));
  // Every double is the one nearest to its decimal, which sums and products of 0.1 are not.
  const Scene scene = parse("snapshots = { from = 0, until = 100, every = 0.1 }");
  const Schedule plan(scene);
  const Times& times = plan.snapshots();
  ASSERT_EQ(times.size(), 1001U);
  for (std::size_t k = 0; k <= 1000; ++k) {
    const std::string digits = std::to_string(k);
    const std::string decimal =
        digits.size() == 1 ? "0." + digits : digits.substr(0, digits.size() - 1) + "." + digits.back();
    EXPECT_EQ(times[k].value, std::stod(decimal));
    EXPECT_EQ(scene.output.snapshots[k], Decimal(decimal));
  }
  EXPECT_NE(times[3].value, 3 * 0.1);
}

// Of the series; 3 0.1 is above 0.3 if it is rounded, and was no sample.
TEST(Schedule, RoundsEveryTimeOnce) {
  const auto series = [](const std::string& keys) {
    return Schedule(parse_scene(ring + "[output]\n" + keys, "ring.toml", {"run.start=0.1", "run.until=10.3"})).series();
  };
  EXPECT_EQ(Schedule(parse_scene(ring + "[output]\nseries.every = 0.1", "", {"run.until=0.3"})).series().rounded(),
            (std::vector<double>{0, 0.1, 0.2, 0.3}));
  const auto near = [](double time, const Rational& exact) {
    const double ulp = std::nextafter(time, 1e300) - time;
    EXPECT_LE(abs(Rational(Rational(time) - exact)), Rational(ulp) / 2) << time;
  };
  const Rational start(1, 10), until(103, 10);
  const auto even = series("series = { points = 1000 }"), over = series("series = { points = 9, over = 3 }");
  ASSERT_EQ(even.size(), 1000U);
  for (std::size_t k = 0; k < 1000; ++k) near(even[k].value, start + (until - start) * Rational(k) / 999);
  EXPECT_EQ(over.size(), 30U);  // up to 29/8 of the range, and the end
  near(over[28].value, start + (3 - start) * Rational(28) / 8);
  EXPECT_EQ(over.back().value, 10.3);
  const auto log = series("series = { points = 20, spacing = 'log' }");
  ASSERT_EQ(log.size(), 20U);
  EXPECT_EQ(log.back().value, 10.3);
  EXPECT_EQ(log[1].value, 0.1000102);
}

TEST(TimeRange, PointsAreEvenOrOfEqualRatios) {
  EXPECT_EQ(snapshots("{ from = 0, until = 1, points = 11 }"),
            (Strings{"0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"}));
  EXPECT_EQ(snapshots("{ from = 0, until = 1, points = 4, spacing = 'linear' }"),
            (Strings{"0", "0.333333333333333", "0.666666666666667", "1"}));
  EXPECT_EQ(snapshots("{ from = 0.01, until = 100, points = 5, spacing = 'log' }"),
            (Strings{"0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(snapshots("{ from = 1, until = 2, points = 3, spacing = 'log' }"), (Strings{"1", "1.4142135623731", "2"}));
  // The ends are kept with all their digits.
  EXPECT_EQ(snapshots("{ from = '0.12345678901234567890', until = 1, points = 2 }").front(), "0.12345678901234567890");
}

TEST(TimeRange, EndsAreThoseOfTheRunWhereNotGiven) {
  EXPECT_EQ(snapshots("{ every = 50 }"), (Strings{"0", "50", "100"}));
  EXPECT_EQ(snapshots("{ every = 50 }", {"run.start=20"}), (Strings{"20", "70"}));
  EXPECT_EQ(snapshots("{ from = 60, every = 20 }", {"run.until=90"}), (Strings{"60", "80"}));
  EXPECT_EQ(snapshots("{ from = 20, points = 2, spacing = 'log' }"), (Strings{"20", "100"}));
}

// Keys that take lists of times take ranges, whatever they are called.
TEST(TimeRange, StandsInEveryKeyOfTimes) {
  const std::string range = "{ from = 10, until = 30, every = 10 }";
  const Scene scene = parse("series.times = " + range + "\nsnapshots = " + range + "\nmasses = " + range +
                            "\nprofiles = { bins = 5, times = " + range + " }");
  for (const char* key : {"output.series.times", "output.snapshots", "output.masses", "output.profiles.times"}) {
    EXPECT_TRUE(takes_times(*find_field(key, scene))) << key;
    EXPECT_EQ(value_text(*find_field(key, scene), scene), "[10, 20, 30]") << key;
  }
  for (const char* key : {"output.series.every", "output.profiles.range", "initial.x", "run.until"})
    EXPECT_FALSE(takes_times(*find_field(key, scene))) << key;
  EXPECT_EQ(scene.output.profiles.bins, 5U);
  // A scene holds lists: it is the same scene, with the same text.
  EXPECT_EQ(effective_toml(parse("snapshots = " + range)), effective_toml(parse("snapshots = [10, 20, 30]")));
}

TEST(TimeRange, IsSetOnTheCommandLine) {
  EXPECT_EQ(snapshots("[1, 2]", {"output.snapshots={ from = 3, until = 4, every = 1 }"}), (Strings{"3", "4"}));
  EXPECT_EQ(snapshots("{ from = 3, until = 4, every = 1 }", {"output.snapshots.every=0.5"}),
            (Strings{"3", "3.5", "4"}));
  EXPECT_EQ(snapshots("[1, 2]", {"output.snapshots.every=50"}), (Strings{"0", "50", "100"}));
  EXPECT_EQ(snapshots("{ from = 3, until = 4, every = 1 }", {"output.snapshots=[7]"}), (Strings{"7"}));
  EXPECT_TRUE(snapshots("{ from = 3, until = 4, every = 1 }", {"output.snapshots="}).empty());
  const Scene series = parse("series = { points = 9 }", {"output.series.times.from=1", "output.series.times.points=2"});
  EXPECT_FALSE(series.output.series.points);
  EXPECT_EQ(series.output.series.times, (std::vector{Decimal("1"), Decimal("100")}));
  // A run cut short keeps the times of the file that are within it, and none of the command line outside.
  EXPECT_EQ(snapshots("{ from = 0, until = 100, every = 30 }", {"run.until=50"}), (Strings{"0", "30"}));
}

}  // namespace cradle::tools::time_range_test
