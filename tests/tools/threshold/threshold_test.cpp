// `cradle threshold`: values at which outcomes change that are known in closed form, decisions in rationals beside
// runs, and continuation to the last byte. (What is refused: tests/tools/messages.txt.)

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/threshold/bracket.hpp"
#include "cradle/tools/threshold/exact_collapse.hpp"

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
    ASSERT_TRUE(run.end == tools::RunEnd::collapsed || run.end == tools::RunEnd::reached);
    EXPECT_EQ(exact->collapse, run.end == tools::RunEnd::collapsed);
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

class ThresholdCommand : public ProgramTest {
 protected:
  std::string end(const std::string& file, const std::string& name) const {
    return tools::attribute<std::string>(read(file).find("threshold")->attributes, name, file);
  }
  double value(const std::string& file) const {
    return tools::attribute<double>(read(file).find("threshold")->attributes, "low", file);
  }
  std::uint64_t proved(const std::string& file, const std::string& name) const {
    return tools::attribute<std::uint64_t>(read(file).find("threshold")->attributes, name + "_proved", file);
  }
};

TEST_F(ThresholdCommand, ProvesTheCollapseOfThreeParticlesToThirtyDigits) {
  const Printed printed = shell("cradle threshold collapse3 --vary law.restitution=0.05:0.1 --digits 30 -o a.h5", 0);
  EXPECT_EQ(end("a.h5", "low_digits"), "0.071796769724490825890214633976") << "7 - 4 sqrt(3)";
  EXPECT_EQ(end("a.h5", "high_digits"), "0.071796769724490825890214633977");
  EXPECT_EQ(end("a.h5", "low_outcome"), "inelastic collapse");
  EXPECT_EQ(proved("a.h5", "low"), 1U);
  EXPECT_EQ(proved("a.h5", "high"), 1U);
  EXPECT_TRUE(has(printed.out, "The outcome changes in between: proved")) << printed.out;
  shell("cradle threshold collapse3 --vary law.restitution=0.2:0.3 --set 'initial.m=[4, 1, 4]' -o b.h5", 0);
  EXPECT_EQ(end("b.h5", "low_digits"), "0.25") << "masses 4, 1, 4";
}

// A particle of mass 1 between a wall and one of mass M makes as many collisions as pi holds the angle atan(1/sqrt M)
// (Galperin 2003): 31 for M = 100, and one more from M = cot^2(pi/32) on. In double the speeds of 31 collisions are
// right to 31 roundings, so the value is to some 1e-14 of itself; the last digit is 1e-9.
const std::string galperin =
    " --outcome collisions --set law.type=inelastic --set law.restitution=1 --set initial.type=list --set "
    "'initial.x=[1, 2]' --set 'initial.v=[0, -1]' --set 'initial.m=[1, 100]' --set walls.left.position=0 --set "
    "run.until=1e30 --set output.events=false --set run.collapse= --set run.stop_gap= ";

TEST_F(ThresholdCommand, FindsACountOfCollisions) {
  shell("cradle threshold collapse3 --vary 'initial.m[1]=100:110'" + galperin + "-o a.h5", 0);
  const double known = std::pow(std::tan(std::numbers::pi / 32), -2);
  EXPECT_NEAR(value("a.h5"), known, 1e-9);
  EXPECT_EQ(end("a.h5", "low_outcome"), "31 collisions");
  EXPECT_EQ(end("a.h5", "high_outcome"), "32 collisions");
}

// Three particles without collapse: their collisions are proved, in double and in wide types.
TEST_F(ThresholdCommand, ProvesCountsOfCollisions) {
  for (const char* digits : {"12", "20"}) {
    shell(std::string("cradle threshold collapse3 --outcome collisions --vary law.restitution=0.08:0.2 --set "
                      "run.until=100 -o a.h5 --force --digits ") +
              digits,
          0);
    EXPECT_EQ(proved("a.h5", "low"), 1U) << end("a.h5", "low_how");
    EXPECT_EQ(proved("a.h5", "high"), 1U) << end("a.h5", "high_how");
    EXPECT_EQ(end("a.h5", "low_outcome"), "11 collisions");
    EXPECT_EQ(end("a.h5", "high_outcome"), "10 collisions");
  }
}

// Two wet particles of masses 1 and 2 that meet at speed 1 have mu w^2/2 = 1/3.
TEST_F(ThresholdCommand, FindsWhetherWetParticlesPass) {
  write("pair.toml", "[law]\ntype = 'wet'\nloss = 0.1\n[initial]\ntype = 'list'\nx = [0, 1]\nv = [1, 0]\nm = [1, 2]\n"
                     "[run]\nuntil = 3\n");
  shell("cradle threshold pair.toml --vary law.loss=0.1:0.4 --digits 20 -o a.h5", 0);
  EXPECT_EQ(end("a.h5", "low_digits"), "0.33333333333333333333");
  EXPECT_EQ(end("a.h5", "high_digits"), "0.33333333333333333334");
  EXPECT_EQ(end("a.h5", "low_outcome"), "0 merges");
  EXPECT_EQ(end("a.h5", "high_outcome"), "1 merges");
  EXPECT_EQ(proved("a.h5", "low") + proved("a.h5", "high"), 2U);
}

// The model of Fig. 9: with a small loss the clusters pass, with the figure's they stick.
TEST_F(ThresholdCommand, FindsWhetherClustersPass) {
  shell("cradle threshold fig9b --vary law.loss=0.01:0.05 --digits 3 -o a.h5", 0);
  EXPECT_EQ(end("a.h5", "low_digits"), "0.0326");
  EXPECT_EQ(end("a.h5", "low_outcome"), "they pass");
  EXPECT_EQ(end("a.h5", "high_outcome"), "they stick");
  EXPECT_EQ(proved("a.h5", "low") + proved("a.h5", "high"), 0U);
}

TEST_F(ThresholdCommand, OfMoreDigitsContinuesFromItsFile) {
  const std::string command = "cradle threshold collapse3 --vary 'initial.m[1]=100:110'" + galperin;
  shell(command + "--digits 12 -o fresh.h5", 0);
  shell(command + "--digits 5 -o a.h5 && " + command + "--digits 12 -o a.h5", 0);
  expect_same("fresh.h5", "a.h5");
  EXPECT_FALSE(exists("a.h5.part"));
}

// Killed when it has made some runs; a longer search if this one was over by then.
TEST_F(ThresholdCommand, ContinuesAfterAKillToTheSameBytes) {
  std::string command;
  for (int digits = 50; digits <= 800 && !exists("a.h5.part"); digits *= 2) {
    command = "cradle threshold collapse3 --vary 'initial.m[1]=10000:11000'" + galperin + "--quiet --digits " +
              std::to_string(digits) + " -o ";
    shell("rm -f a.h5; " + command +
          "a.h5 & pid=$!; until cradle info a.h5.part 2>.not-yet | grep -q ': [1-9][0-9]* runs' || test -e a.h5; do "
          "sleep 0.01; done; kill -9 $pid; wait $pid");
  }
  ASSERT_TRUE(exists("a.h5.part"));
  ASSERT_FALSE(exists("a.h5"));
  EXPECT_TRUE(has(shell("cradle resume a.h5", 2).err, "a search for a threshold"));
  EXPECT_TRUE(has(shell("cradle run collapse3 -o a.h5", 2).err, "work of another command that is not finished"));
  EXPECT_TRUE(has(shell("cradle export a.h5.part --to csv", 4).err, "runs of a threshold that is not found yet"));
  const std::string other = "cradle threshold collapse3 --vary law.restitution=0.05:0.1 --digits 3 -o c.h5";
  shell("cp a.h5.part c.h5.part", 0);
  EXPECT_TRUE(has(shell(other, 2).err, "unfinished work of something else"));
  shell(other + " --force", 0);
  shell(command + "a.h5 && " + command + "b.h5", 0);
  expect_same("a.h5", "b.h5");
  EXPECT_FALSE(exists("a.h5.part"));
}

}  // namespace cradle::tests::threshold_test
