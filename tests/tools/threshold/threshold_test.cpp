// `cradle threshold`: decisions in rationals beside runs. (Values at which outcomes change that are known in closed
// form, continuation to the last byte: tests/tools/outputs.txt. What is refused: tests/tools/messages.txt.)

#include <random>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/threshold/threshold.hpp"

namespace cradle::tests::threshold_test {

using tools::Bracket;
using tools::Decimal;

// The number of values tried, and the last two.
std::string closed_in(const char* low, const char* high, unsigned digits, bool whole, const char* threshold) {
  Bracket bracket{Decimal(low), Decimal(high), digits, whole};
  int tried = 0;
  for (; bracket.next(); ++tried) bracket.narrow(*bracket.next() < Decimal(threshold));
  return std::to_string(tried) + ": " + bracket.low().text + " " + bracket.high().text;
}

TEST(Bracket, EndsAtNeighbouringDecimals) {
  EXPECT_EQ(closed_in("0.05", "0.1", 12, false, "0.07179676972449082"), "35: 0.071796769724 0.071796769725");
  EXPECT_EQ(closed_in("-1", "1", 4, false, "-0.123456"), "11: -0.124 -0.123");
  EXPECT_EQ(closed_in("0", "1e-5", 3, false, "2.5e-7"), "6: 0.0000002 0.0000003");
  EXPECT_EQ(closed_in("1e40", "9e40", 5, false, "2.5123456e40"), "16: 25123e36 25124e36");
  EXPECT_EQ(closed_in("2", "100", 12, true, "37"), "7: 36 37");
  EXPECT_EQ(closed_in("1.05", "1.06", 3, false, "1.055"), "0: 1.05 1.06");
}

TEST(Bracket, OfMoreDigitsTriesTheSameValuesFirst) {
  const auto tried = [](unsigned digits) {
    std::vector<std::string> values;
    for (Bracket bracket{Decimal("0.3"), Decimal("17"), digits, false}; bracket.next();) {
      values.push_back(bracket.next()->text);
      bracket.narrow(*bracket.next() < Decimal("2.718281828459045"));
    }
    return values;
  };
  const auto few = tried(5), many = tried(12);
  ASSERT_LT(few.size(), many.size());
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

std::string three_particles(const std::string& restitution, const std::string& x, const std::string& v,
                            const std::string& m, const std::string& until) {
  return "[law]\ntype = 'inelastic'\nrestitution = " + restitution + "\n[initial]\ntype = 'list'\nx = " + x +
         "\nv = " + v + "\nm = " + m + "\n[run]\nuntil = " + until + "\n[output]\nseries = { points = 2 }\n";
}

// A run in double proves a collapse with bounds on its rounding, or ends without one: then nothing more collides. Both
// must be what rationals say, also for ends between the first collision and the collapse.
TEST(ExactCollapse, IsThatOfRuns) {
  int collapses = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const auto number = [&](std::uint64_t from, std::uint64_t to) {
      return std::to_string(from + random() % (to - from)) + "e-3";
    };
    const std::string masses =
        seed % 2 == 0 ? "[1, 1, 1]"
                      : "[" + number(500, 2000) + ", " + number(500, 2000) + ", " + number(500, 2000) + "]";
    const auto scene =
        tools::parse_scene(three_particles(number(5, 120), "[0, " + number(100, 1000) + ", " + number(1100, 2000) + "]",
                                           "[" + number(0, 1000) + ", " + number(0, 10) + ", -" + number(1, 1000) + "]",
                                           masses, number(200, 9000)),
                           "three.toml");
    const auto exact = tools::exact_collapse(scene);
    const tools::RunOutcome run = tools::run_scene(scene, {tools::Progress::Show::never});
    ASSERT_TRUE(exact);
    if (run.end == tools::RunEnd::exhausted) continue;  // underflows before it parts
    EXPECT_EQ(run.end, exact->collapse ? tools::RunEnd::collapsed : tools::RunEnd::reached);
    (exact->collapse ? collapses : others) += 1;
  }
  EXPECT_GT(collapses, 50);
  EXPECT_GT(others, 50);
}

TEST(ExactCollapse, LeavesOtherScenesOpen) {
  const auto decided = [](const std::string& restitution, const std::string& x,
                          const std::vector<std::string>& overrides = {}) {
    return tools::exact_collapse(tools::parse_scene(three_particles(restitution, x, "[1, 0, -1]", "[1, 1, 1]", "9"),
                                                    "three.toml", overrides))
        .has_value();
  };
  EXPECT_TRUE(decided("0.05", "[0, 1, 3]"));
  EXPECT_FALSE(decided("0.05", "[0, 1, 2]")) << "three particles meet at one time";
  EXPECT_FALSE(decided("0", "[0, 1, 3]"));
  EXPECT_FALSE(
      decided("0.05", "[0, 1, 3]", {"initial.x=[0, 1, 3, 4]", "initial.v=[1, 0, -1, -1]", "initial.m=[1, 1, 1, 1]"}));
  EXPECT_FALSE(decided("0.05", "[0, 1, 3]", {"law.cutoff=1e-3"}));
  EXPECT_FALSE(decided("0.05", "[0, 1, 3]", {"walls.left.position=-1"}));
  EXPECT_FALSE(decided("0.05", "[0, 1, 3]", {"gravity.acceleration=1"}));
}

}  // namespace cradle::tests::threshold_test
