// The decimals below /exact, for each type wider than double: they have all digits of the numbers whose doubles are in
// the tables, and these numbers are known to the digits of the type.
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

using Exact = ProgramTest;

const std::string inelastic = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n",
                  rows = "initial = { type = 'rows', particles = 20, perturbation = 0.1 }\nrun.until = 5\n",
                  everything = "output = { series.points = 9, snapshots = [2, 4], events = true, core = true }\n",
                  shock = inelastic + rows + everything,
                  wet = "law = { type = 'wet', loss = 0.03 }\n" + rows + everything;

// Of a wet gas there are the heaviest clusters too, beside series, two snapshots, events and the initial state.
void expect_rounded(const Result& result, std::size_t groups) {
  std::size_t exact_groups = 0;
  for (const Group& exact : result.groups) {
    if (!exact.name.starts_with("exact/")) continue;
    ++exact_groups;
    const Group* rounded = result.find(exact.name.substr(6));
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
  EXPECT_EQ(exact_groups, groups);
  const Group* snapshot = result.find("exact/snapshots/0001");
  ASSERT_NE(snapshot, nullptr);
  EXPECT_EQ(attribute<std::string>(snapshot->attributes, "time", "a.h5"), "4");
  Texts names;
  for (const Column& column : snapshot->columns) names.push_back(column.name);
  EXPECT_EQ(names, (Texts{"x", "v", "m", "gap", "closing_speed"}));
}

TEST_F(Exact, DoublesAreTheDecimalsRounded) {
  in_wide_types(shock, [](const Result& result) { expect_rounded(result, 5); });
  in_wide_types(wet, [](const Result& result) { expect_rounded(result, 6); });
}

// Two particles at 0 and 1 with 0.3 and -0.4 and a restitution of 0.7 meet at t = 1/.7 and part with 0.49: their
// velocities are then -0.05 -+ 0.245.
TEST_F(Exact, DecimalsHaveTheDigitsOfTheType) {
  // mpfr has none of its 100 to spare: the closing speed 0.49 is 0.7 less 1.19, off by three roundings of 1.19, half an
  // epsilon each, and the gap by 3.57 times as much, besides its own.
  const std::map<std::string, int> digits{
      {"long double", 18}, {"double-double", 30}, {"float128", 32}, {"cpp_bin_float", 49}, {"mpfr, 100 digits", 98}};
  const std::string scene = "law = { type = 'inelastic', restitution = 0.7 }\nrun.until = 5\n"
                            "initial = { type = 'list', x = [0, 1], v = [0.3, -0.4] }\n"
                            "output = { series.points = 2, snapshots = [5], events = true }\n";
  in_wide_types(scene, [&](const Result& result) {
    const Rational bound = decimal<Rational>(
        "1e-" + std::to_string(digits.at(attribute<std::string>(result.attributes, "precision", ""))));
    const auto near = [&](const char* group, const char* name, std::size_t row, const Rational& expected) {
      const std::string text = numbers<std::string>(result, group, name).at(row);
      EXPECT_LT(abs(Rational(decimal<Rational>(text) - expected)), bound) << group << "/" << name << ": " << text;
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
  });
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

TEST_F(Exact, TimesAreTheDecimalsOfTheScene) {
  const std::string tenths =
      inelastic + rows +
      "[output]\nseries.every = 0.1\nsnapshots = { from = 0.1, until = 4.9, every = 0.1 }\n"
      "profiles.times = { from = 0.1, until = 4.9, every = 0.1 }\n"
      "structure = { length = 20, times = { from = 0.1, until = 4.9, every = 0.1 } }\ncorrelations.every = 0.1\n";
  expect_multiples_of_a_tenth(result_of(tenths));
  in_wide_types(tenths, expect_multiples_of_a_tenth);
}

}  // namespace cradle::tests::exact_test
