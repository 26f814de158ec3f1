// Ranges of times in place of lists, and the doubles nearest to their decimals. (That these are the decimals of a
// range: decimal_test.cpp and run/exact_test.cpp; in files and on the command line: values.txt. Messages:
// tests/tools/messages.txt.)

#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::time_range_test {

using cradle::test::Rational;

Scene parse(const std::string& output, const std::vector<std::string>& overrides = {}) {
  const std::string ring = "law.type = 'sticky'\ninitial = { type = 'ring', particles = 10 }\nrun.until = 100\n";
  return parse_scene(ring + "[output]\n" + output, "s.toml", overrides);
}

// Of the series; 3 0.1 is above 0.3 if it is rounded, and was no sample.
TEST(Schedule, RoundsEveryTimeOnce) {
  const auto series = [](const std::string& keys) {
    return Schedule(parse(keys, {"run.start=0.1", "run.until=10.3"})).series();
  };
  EXPECT_EQ(Schedule(parse("series.every = 0.1", {"run.until=0.3"})).series().rounded(),
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

// Keys that take lists of times take ranges, whatever they are called.
TEST(TimeRange, StandsInEveryKeyOfTimes) {
  const Scene scene = parse("snapshots = { from = 10, until = 30, every = 10 }");
  for (const char* key : {"output.series.times", "output.snapshots", "output.masses", "output.profiles.times"})
    EXPECT_TRUE(takes_times(*find_field(key, scene))) << key;
  for (const char* key : {"output.series.every", "output.profiles.range", "initial.x", "run.until"})
    EXPECT_FALSE(takes_times(*find_field(key, scene))) << key;
  // A scene holds lists: it is the same scene, with the same text.
  EXPECT_EQ(effective_toml(scene), effective_toml(parse("snapshots = [10, 20, 30]")));
}

}  // namespace cradle::tools::time_range_test
