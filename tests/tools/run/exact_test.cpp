// The decimals below /exact, for each type wider than double: they have all digits of the numbers whose doubles are in
// the tables, and these numbers are known to the digits of the type.
#include <cmath>
#include <map>

#include "cradle/precision/text.hpp"
#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::exact_test {

using namespace cradle::tools;
using test::decimal;
using test::Rational;
using Texts = std::vector<std::string>;

// Of the type's number, which may be a tie between doubles, the decimal is off by a little.
bool rounds_to(const std::string& text, double value) {
  const double size = std::abs(value), ulp = std::nextafter(size, 1e300) - size;
  return abs(Rational(decimal<Rational>(text) - Rational(value))) <= Rational(ulp) * Rational(513, 1024);
}

const std::map<std::string, int>& digits_of_types() {
  static const std::map<std::string, int> types{
      {"long double", 18}, {"double-double", 30}, {"float128", 32}, {"cpp_bin_float", 49}, {"mpfr", 100}};
  return types;
}

class Exact : public ProgramTest {
 protected:
  // Nothing where this build has not that type.
  std::vector<Result> run(const std::string& scene, const std::string& precision) {
    std::string text = scene + "[run]\nuntil = 5\nprecision = \"" + precision + "\"\n";
    if (precision == "mpfr") text += "digits = 100\n";
    write("scene.toml", text);
    const Printed run = shell("cradle run scene.toml --quiet --force -o a.h5");
    if (has(run.err, "not in this build")) return {};
    EXPECT_EQ(run.status, 0) << run.err;
    return {read("a.h5")};
  }
};

class ExactIn : public Exact, public testing::WithParamInterface<const char*> {};

const std::string everything = "output = { series.points = 9, snapshots = [2, 4], events = true, core = true }\n";
const std::string shock = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\ninitial = { type = 'rows', "
                          "particles = 20, perturbation = 0.1 }\n" +
                          everything,
                  wet = "law = { type = 'wet', loss = 0.03 }\ninitial = { type = 'rows', particles = 20, "
                        "perturbation = 0.1 }\n" +
                        everything;

TEST_P(ExactIn, DoublesAreTheDecimalsRounded) {
  for (const std::string& scene : {shock, wet}) {
    SCOPED_TRACE(scene);
    const std::vector<Result> results = run(scene, GetParam());
    if (results.empty()) return;
    std::size_t exact_groups = 0;
    for (const Group& exact : results[0].groups) {
      if (!exact.name.starts_with("exact/")) continue;
      ++exact_groups;
      const Group* rounded = results[0].find(exact.name.substr(6));
      ASSERT_NE(rounded, nullptr) << exact.name;
      std::size_t more = 0;  // than the double says
      for (const Column& column : exact.columns) {
        SCOPED_TRACE(exact.name + "/" + column.name);
        const Column& twin = tests::column(*rounded, column.name);
        EXPECT_EQ(column.unit, twin.unit);
        EXPECT_EQ(column.width, twin.width);
        const auto& texts = std::get<Texts>(column.values);
        const auto& doubles = std::get<std::vector<double>>(twin.values);
        ASSERT_EQ(texts.size(), doubles.size());
        for (std::size_t k = 0; k < texts.size(); ++k) {
          if (texts[k] == "nan") {
            EXPECT_TRUE(std::isnan(doubles[k]));
            continue;
          }
          EXPECT_TRUE(rounds_to(texts[k], doubles[k])) << texts[k] << " " << doubles[k];
          more += texts[k] != to_text(doubles[k]);
        }
      }
      EXPECT_GT(more, 0U) << exact.name;
    }
    // series, two snapshots, events, the initial state; wet: the heaviest clusters too
    EXPECT_EQ(exact_groups, scene == wet ? 6U : 5U);
    const Group* snapshot = results[0].find("exact/snapshots/0001");
    ASSERT_NE(snapshot, nullptr);
    EXPECT_EQ(attribute<std::string>(snapshot->attributes, "time", "a.h5"), "4");
    Texts names;
    for (const Column& column : snapshot->columns) names.push_back(column.name);
    EXPECT_EQ(names, (Texts{"x", "v", "m", "gap", "closing_speed"}));
  }
}

// Two particles at 0 and 1 with 0.3 and -0.4 and a restitution of 0.7 meet at t = 1/.7 and part with 0.49: their
// velocities are then -0.05 -+ 0.245.
TEST_P(ExactIn, DecimalsHaveTheDigitsOfTheType) {
  const std::vector<Result> results =
      run("law = { type = 'inelastic', restitution = 0.7 }\ninitial = { type = 'list', x = [0, 1], v = [0.3, -0.4] }\n"
          "output = { series.points = 2, snapshots = [5], events = true }\n",
          GetParam());
  if (results.empty()) return;
  const auto near = [&](const char* group, const char* name, std::size_t row, const Rational& expected) {
    const std::string text = numbers<std::string>(results[0], group, name).at(row);
    // mpfr has no digits to spare: the closing speed 0.49 is 0.7 less 1.19, off by three roundings of 1.19, half an
    // epsilon each, and the gap by 3.57 times as much, besides its own.
    const int digits = digits_of_types().at(GetParam()) - (GetParam() == std::string("mpfr") ? 2 : 0);
    EXPECT_LT(abs(Rational(decimal<Rational>(text) - expected)), decimal<Rational>("1e-" + std::to_string(digits)))
        << group << "/" << name << ": " << text;
  };
  const Rational left(-295, 1000), right(195, 1000), met(10, 7), place(3, 7);
  near("exact/series", "time", 1, 5);
  near("exact/series", "energy", 1, (left * left + right * right) / 2);
  near("exact/series", "front_left", 1, place + left * (5 - met));
  near("exact/snapshots/0000", "x", 1, place + right * (5 - met));
  near("exact/snapshots/0000", "v", 0, left);
  near("exact/snapshots/0000", "gap", 0, Rational(49, 100) * (5 - met));
  near("exact/events", "time", 0, met);
  near("exact/events", "closing_speed", 0, Rational(7, 10));
}

// Times of rows, attributes and lags: multiples of 0.1, as doubles and, in types that have more digits, as decimals.
void expect_multiples_of_a_tenth(const Result& result) {
  const auto multiple = [](std::size_t k) {
    const std::string tenths = std::to_string(k % 10), whole = std::to_string(k / 10);
    return tenths == "0" ? whole : whole + "." + tenths;
  };
  const auto times = numbers(result, "series", "time"), lags = numbers(result, "correlations", "lag");
  ASSERT_EQ(times.size(), 51U);
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_EQ(times[k], std::stod(multiple(k)));
  for (const double lag : lags) EXPECT_EQ(lag, std::stod(multiple(static_cast<std::size_t>(std::lround(10 * lag)))));
  if (const Group* exact = result.find("exact/series")) {
    const auto& texts = std::get<Texts>(exact->columns.front().values);
    for (std::size_t k = 0; k < times.size(); ++k) EXPECT_EQ(texts.at(k), multiple(k));
  }
  std::map<std::string, std::size_t> found;
  for (const Group& group : result.groups)
    for (const auto& [name, value] : group.attributes) {
      if (name != "time") continue;
      const std::string folder = group.name.substr(0, group.name.rfind('/'));
      const std::string expected = multiple(++found[folder]);
      if (folder.starts_with("exact")) {
        EXPECT_EQ(std::get<std::string>(value), expected) << group.name;
      } else {
        EXPECT_EQ(std::get<double>(value), std::stod(expected)) << group.name;
      }
    }
  for (const char* folder : {"snapshots", "profiles", "structure"}) EXPECT_EQ(found[folder], 49U) << folder;
}
const std::string tenths = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\ninitial = { type = 'rows', "
                           "particles = 20, perturbation = 0.1 }\n[output]\nseries.every = 0.1\nsnapshots = { from = "
                           "0.1, until = 4.9, every = 0.1 }\nprofiles.times = { from = 0.1, until = 4.9, every = 0.1 "
                           "}\nstructure = { length = 20, times = { from = 0.1, until = 4.9, every = 0.1 } }\n"
                           "correlations.every = 0.1\n";

TEST_P(ExactIn, TimesAreTheDecimalsOfTheScene) {
  for (const Result& result : run(tenths, GetParam())) expect_multiples_of_a_tenth(result);
}
TEST_F(Exact, TimesOfDoublesAreTheDecimalsOfTheScene) {
  for (const Result& result : run(tenths, "double")) expect_multiples_of_a_tenth(result);
}

INSTANTIATE_TEST_SUITE_P(Types, ExactIn,
                         testing::Values("long double", "double-double", "float128", "cpp_bin_float", "mpfr"),
                         [](const auto& type) {
                           std::string name = type.param;
                           std::erase_if(name, [](char c) { return c == ' ' || c == '-' || c == '_'; });
                           return name;
                         });

TEST_F(Exact, DoublesNeedNone) {
  const std::vector<Result> results = run(shock, "double");
  ASSERT_EQ(results.size(), 1U);
  for (const Group& group : results[0].groups) EXPECT_FALSE(group.name.starts_with("exact")) << group.name;
}

}  // namespace cradle::tests::exact_test
