// Lists of particles: decimals of any length survive, and what is wrong in a file is named with its line.
#include "cradle/tools/scene/list_file.hpp"

#include <sstream>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tools::list_file_test {

using test::begins;
using tests::refusal;

ListedParticles parse(const std::string& text, Precision precision = Precision::double_) {
  std::istringstream csv(text);
  Run run;
  run.precision = precision;
  return parse_list(csv, "b.csv", run);
}

std::string message(const std::string& text) {
  return refusal(Exit::bad_input, [&] { parse(text); });
}

TEST(ListFile, AcceptsWhatEditorsWrite) {
  const std::string digits(60, '3');
  const ListedParticles particles =
      parse("\xEF\xBB\xBF# particles\r\n\r\n x , v , m \r\n-1e-400, +10 ,2\r\n# middle\r\n0." + digits +
            ",-0.5,1e-7\r\n\r\n");
  ASSERT_EQ(particles.x.size(), 2U);
  EXPECT_EQ(particles.x[0], "-1e-400");
  EXPECT_EQ(particles.v[0], "10");
  EXPECT_EQ(particles.m[0], "2");
  EXPECT_EQ(particles.x[1], "0." + digits);
  EXPECT_EQ(particles.v[1], "-0.5");
  EXPECT_EQ(particles.m[1], "1e-7");
  EXPECT_TRUE(parse("x,v\n0,1\n1,2").m.empty());  // no line end at the end
}

TEST(ListFile, RefusesWithTheLine) {
  EXPECT_EQ(message(""),
            "b.csv: no particles (found an empty file): give a line x,v or x,v,m and then one line per particle");
  EXPECT_TRUE(begins(message("x,v\n\n"), "b.csv: no particles (found only the names of the columns)"));
  EXPECT_EQ(message("0,1\n"), "b.csv:1: the columns are not named (found a line of numbers, 2 of them): begin the file "
                              "with a line x,v or x,v,m");
  EXPECT_TRUE(begins(message("v,x\n"), "b.csv:1:"));
  EXPECT_EQ(message("x,v\n0,1,2\n"), "b.csv:2: wrong number of columns (found 3): give 2 as in the first line");
  EXPECT_EQ(message("x,v,m\n0,1\n"), "b.csv:2: wrong number of columns (found 2): give 3 as in the first line");
  EXPECT_EQ(message("x,v\n0,nan\n"), "b.csv:2: v: not finite (found \"nan\"): give a decimal number");
  EXPECT_EQ(message("x,v\n-Inf,0\n"), "b.csv:2: x: not finite (found \"-Inf\"): give a decimal number");
  EXPECT_EQ(message("x,v\n0,\n"), "b.csv:2: v: not a decimal number (found \"\"): give a decimal number");
  EXPECT_EQ(message("x,v\n0,1 2\n"), "b.csv:2: v: not a decimal number (found \"1 2\"): give a decimal number");
  EXPECT_EQ(message("x,v,m\n0,1,0.0\n"), "b.csv:2: m: out of range (found 0.0): give a mass above 0");
}

TEST(ListFile, OrderIsDecidedExactly) {
  const std::string zeros(40, '0');
  parse("x,v\n1,0\n1." + zeros + "1,0\n");
  EXPECT_EQ(message("x,v\n1,0\n\n1." + zeros + ",0\n"), "b.csv:4: x: coincident particles (found 1." + zeros +
                                                            " after 1): give the particles in order of increasing x");
  EXPECT_EQ(message("x,v\n-1,0\n-1e1,0\n"),
            "b.csv:3: x: not increasing (found -1e1 after -1): give the particles in order of increasing x");
}

// What other readers take for some number or other.
TEST(ListFile, NumbersAreDecimalsAndNothingElse) {
  for (const char* cell :
       {"1_0", "0x10", "0x1p3", "1 0", "1e 5", "--5", "+-5",   "-+5", "1e+-5",     "1e5_0",
        "1d5", "1e",   "e5",    ".",   "",     "5f",  "1'000", "١",   "1\xC2\xA0", "1e0000000000000000005"})
    EXPECT_EQ(message(std::string("x,v\n0,") + cell + "\n"),
              std::string("b.csv:2: v: not a decimal number (found \"") + cell + "\"): give a decimal number");
  for (const char* cell : {"inf", "-Infinity", "NaN", "+nan"})
    EXPECT_EQ(message(std::string("x,v\n0,") + cell + "\n"),
              std::string("b.csv:2: v: not finite (found \"") + cell + "\"): give a decimal number");
}

TEST(ListFile, NumbersAreSuchThatThePrecisionHoldsThem) {
  EXPECT_EQ(message("x,v\n0,1\n1,1e400\n"),
            "b.csv:3: v: too large for the precision (found 1e400 with \"double\"): give a smaller number or another "
            "run.precision");
  EXPECT_TRUE(begins(message("x,v\n-1e309,1\n"), "b.csv:2: x: too large for the precision (found -1e309"));
  EXPECT_TRUE(begins(message("x,v,m\n0,1,1e-400\n"), "b.csv:2: m: too small for the precision (found 1e-400"));
  EXPECT_EQ(parse("x,v\n0,1e400\n", Precision::float128).v[0], "1e400");
  EXPECT_EQ(parse("x,v,m\n0,1e99999,1e-99999\n", Precision::mpfr).m[0], "1e-99999");
  EXPECT_THROW(parse("x,v\n0,1e99999\n", Precision::long_double), Error);
}

TEST(ListFile, ParticlesOfAScene) {
  const std::string head = "law.type = 'sticky'\nrun.until = 1\ninitial.type = 'list'\n";
  const Initial particles = parse_scene(head + "initial.x = [0, 1e-500]\ninitial.v = [1, -1]", "s.toml").initial;
  ASSERT_EQ(particles.x.size(), 2U);
  EXPECT_EQ(particles.x[1], "1e-500");
  EXPECT_TRUE(particles.m.empty());
  EXPECT_TRUE(begins(refusal(Exit::io, [&] { parse_scene(head + "initial.file = 'absent.csv'", "nowhere/s.toml"); }),
                     "nowhere/absent.csv: the list of particles cannot be read (found "));
}

}  // namespace cradle::tools::list_file_test
