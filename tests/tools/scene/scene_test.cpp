// Scenes as a user writes them: literals survive exactly, the effective scene reads back as the same scene
// (values.txt), ranges of times are lists of the doubles nearest to their decimals. (The decimals: decimal_test.cpp,
// run/exact_test.cpp. What is refused, and with which message: tests/tools/messages.txt. Lists in files: outputs.txt.)
#include "cradle/tools/scene/scene.hpp"

#include "cradle/tests/core/rational.hpp"
#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/record/schedule.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::scene_test {

using test::has;
using tests::refusal;
using Strings = std::vector<std::string>;

const std::string good = "law.type = 'inelastic'\nlaw.restitution = 0.999\ninitial.type = 'rows'\n"
                         "initial.particles = 8000\nrun.until = 6500\n";

Scene parse(const std::string& text, const Strings& overrides = {}) { return parse_scene(text, "s.toml", overrides); }

// The effective scene reads back as the same scene, with the same text.
void expect_read_back(const Scene& scene) {
  const std::string effective = effective_toml(scene);
  const Scene again = parse_scene(effective, "elsewhere/t.toml");
  EXPECT_TRUE(again == scene) << effective;
  EXPECT_EQ(effective_toml(again), effective);
}

TEST(Scene, HasTheValuesOfTheTable) {
  for (const tests::ListedCase& listed : tests::cases_in("scene/values.txt")) {
    SCOPED_TRACE("values.txt:" + std::to_string(listed.number));
    std::string toml;
    Strings settings, wanted_values;
    for (const std::string& line : listed.lines)
      if (line.starts_with("=> "))
        wanted_values.push_back(line.substr(3));
      else if (line.starts_with("--set "))
        settings.push_back(line.substr(6));
      else
        toml += line + "\n";
    const Scene scene = parse(toml, settings);
    std::string all = "\n";
    for (const auto& [key, text] : values(scene, true)) all.append(key).append(" = ").append(text).append("\n");
    for (const std::string& wanted : wanted_values)
      if (wanted.starts_with("no "))
        EXPECT_FALSE(has(all, "\n" + wanted.substr(3) + " = "));
      else
        EXPECT_TRUE(has(all, "\n" + wanted + "\n"));
    expect_read_back(scene);
  }
}

TEST(Scene, LiteralsMayHaveThousandsOfDigits) {
  const std::string digits = "0." + std::string(5000, '9');
  EXPECT_EQ(parse(good, {"law.restitution=" + digits}).law.restitution.text, digits);
  std::string text = good;
  EXPECT_EQ(parse(text.replace(text.find("0.999"), 5, digits + " # many")).law.restitution.text, digits);
}

// A wall beside a particle by less than any binary number of a hundred digits resolves.
TEST(Scene, WallsStandOutsideTheParticles) {
  const std::string close = "1." + std::string(400, '0') + "1",
                    head = "law = { type = 'inelastic', restitution = 0.5 }\nrun = { until = 1, precision = 'mpfr' "
                           "}\ninitial.type = 'list'\n";
  EXPECT_TRUE(parse(head + "initial.x = [0, 1]\ninitial.v = [0, 0]\nwalls.right.position = " + close).walls.any());
  const std::string among = head + "initial.x = [0, " + close + "]\ninitial.v = [0, 0]\nwalls.right.position = 1\n";
  EXPECT_TRUE(has(refusal(Exit::bad_input, [&] { parse(among); }), "a wall among the particles"));
  EXPECT_FALSE(parse(good).walls.any());
}

TEST(Scene, MassesAndRowsAreOfTwoKinds) {
  EXPECT_TRUE(unequal_masses(parse(good, {"initial.masses=[1,2]"})));
  EXPECT_TRUE(unequal_masses(parse(good, {"initial.masses=[2]"})));
  EXPECT_FALSE(unequal_masses(parse(good, {"initial.masses=[1,1.0]"})));
  EXPECT_FALSE(parse(good).initial.general_rows());
  EXPECT_TRUE(parse(good, {"initial.particles=", "initial.left={particles = 3, speed = 1}",
                           "initial.right={particles = 5, speed = 0.5}"})
                  .initial.general_rows());
}

// How often a run is checkpointed cannot change its result, nor stand in it.
TEST(Scene, CheckpointsAreNoPartOfTheEffectiveScene) {
  const Scene often = parse(good + "[output]\ncheckpoint = { every_seconds = 0.5 }");
  EXPECT_EQ(often.output.checkpoint.every_seconds, tools::Decimal("0.5"));
  EXPECT_EQ(effective_toml(often), effective_toml(parse(good)));
}

TEST(EffectiveScene, ReadsBackAsTheSameScene) {
  for (const EmbeddedFile& bundled : bundled_scenes()) {
    SCOPED_TRACE(bundled.name);
    expect_read_back(read_scene(std::string(bundled.name)));
  }
  EXPECT_FALSE(parse(good) == parse(good, {"law.restitution=0.9990000000000000000000000001"}));
  EXPECT_TRUE(parse(good) == parse(good, {"law.restitution=999e-3"}));
}
using NewScene = tests::ProgramTest;

TEST_F(NewScene, ListsEveryKeyThatItCouldUse) {
  shell("cradle new", 0);
  const std::string text = tests::contents(path("shock.toml"));
  const Scene scene = read_scene(path("shock.toml"));
  for (const Field& field : scene_fields())
    EXPECT_TRUE(!field.when->holds(scene) || has(text, fmt::format("# {} ({})\n", field.doc, facts(field))));
}

// ---- ranges of times

using test::Rational;

Scene with_output(const std::string& output, const Strings& overrides = {}) {
  const std::string ring = "law.type = 'sticky'\ninitial = { type = 'ring', particles = 10 }\nrun.until = 100\n";
  return parse(ring + "[output]\n" + output, overrides);
}

// Of the series; 3 0.1 is above 0.3 if it is rounded, and was no sample.
TEST(Schedule, RoundsEveryTimeOnce) {
  const auto series = [](const std::string& keys) {
    return Schedule(with_output(keys, {"run.start=0.1", "run.until=10.3"})).series();
  };
  EXPECT_EQ(Schedule(with_output("series.every = 0.1", {"run.until=0.3"})).series().rounded(),
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
  const Scene scene = with_output("snapshots = { from = 10, until = 30, every = 10 }");
  for (const char* key : {"output.series.times", "output.snapshots", "output.masses", "output.profiles.times"})
    EXPECT_TRUE(takes_times(*find_field(key, scene))) << key;
  for (const char* key : {"output.series.every", "output.profiles.range", "initial.x", "run.until"})
    EXPECT_FALSE(takes_times(*find_field(key, scene))) << key;
  // A scene holds lists: it is the same scene, with the same text.
  EXPECT_EQ(effective_toml(scene), effective_toml(with_output("snapshots = [10, 20, 30]")));
}

}  // namespace cradle::tools::scene_test
