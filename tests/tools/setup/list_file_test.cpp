// Lists of particles: decimals of any length survive. (What is wrong in a file: tests/tools/messages.txt.)
#include "cradle/tools/setup/list_file.hpp"

#include <sstream>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/setup/read_scene.hpp"

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

// Positions and velocities are what gaps and closing speeds add up to.
TEST(ListFile, GapsAndClosingSpeedsHaveTheLastWord) {
  const auto expect = [](const std::string& text, std::initializer_list<std::string_view> x,
                         std::initializer_list<std::string_view> v) {
    const ListedParticles particles = parse(text);
    EXPECT_TRUE(particles.x == DecimalColumn(x) && particles.v == DecimalColumn(v)) << text;
  };
  expect("gap,v\n0.1,1\n1e-30,2\n,3\n", {"0", "0.1", "0.100000000000000000000000000001"}, {"1", "2", "3"});
  expect("x,gap,v\n1e3,1e-20,1\n,2,2\n,,3\n", {"1000", "1000.00000000000000000001", "1002.00000000000000000001"},
         {"1", "2", "3"});
  // As `export` writes it.
  expect("# time = 1.7\nx,v,m,index,gap,closing_speed\n1.5,1,1,0,1e-13,1e-20\n1.5000000000001,1,1,1,2,0.5\n"
         "3.5000000000001,0.5,1,2,,\n",
         {"1.5", "1.5000000000001", "3.5000000000001"}, {"1", "0.99999999999999999999", "0.49999999999999999999"});
}

// On a ring rounded gaps do not add up to its length: the largest one takes the difference.
TEST(ListFile, GapsAroundARingAddUpToItsLength) {
  std::istringstream csv("gap,v\n1e-13,1\n2.0000001,2\n0.9999999,3\n");
  const ListedParticles particles = parse_list(csv, "b.csv", tools::Run(), Decimal("3"));
  EXPECT_TRUE(particles.x == DecimalColumn({"0", "1e-13", "2.0000001"}));
  std::istringstream other("gap,v\n1,1\n1,2\n");
  EXPECT_EQ(refusal(Exit::bad_input, [&] { parse_list(other, "b.csv", tools::Run(), Decimal("3")); }),
            "b.csv: numbers that do not add up to that of the ring (found 2 for 3): leave out the last one, or correct "
            "it");
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
  EXPECT_EQ(parse("x,v\n0,1e400\n", Precision::float128).v[0], "1e400");
  EXPECT_EQ(parse("x,v,m\n0,1e99999,1e-99999\n", Precision::mpfr).m[0], "1e-99999");
  EXPECT_THROW(parse("x,v\n0,1e99999\n", Precision::long_double), Error);
}

TEST(ListFile, ParticlesOfAScene) {
  const std::string head = "law.type = 'sticky'\nrun = { until = 1, precision = 'float128' }\ninitial.type = 'list'\n";
  const Initial particles = parse_scene(head + "initial.x = [0, 1e-500]\ninitial.v = [1, -1]", "s.toml").initial;
  ASSERT_EQ(particles.x.size(), 2U);
  EXPECT_EQ(particles.x[1], "1e-500");
  EXPECT_TRUE(particles.m.empty());
  EXPECT_TRUE(begins(refusal(Exit::io, [&] { parse_scene(head + "initial.file = 'absent.csv'", "nowhere/s.toml"); }),
                     "nowhere/absent.csv: the list of particles cannot be read (found "));
}

}  // namespace cradle::tools::list_file_test
