// Scenes as a user writes them: literals survive exactly, and the effective scene reads back as the same scene
// (values.txt). What is refused, and with which message, is in tests/tools/messages.txt.
#include "cradle/tools/scene/scene.hpp"

#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::scene_test {

using test::has;
using tests::contents;
using tests::ProgramTest;
using tests::refusal;
using Strings = std::vector<std::string>;

const std::string good = "law.type = 'inelastic'\nlaw.restitution = 0.999\ninitial.type = 'rows'\n"
                         "initial.particles = 8000\nrun.until = 6500\n";

Scene parse(const std::string& text, const Strings& overrides = {}) { return parse_scene(text, "s.toml", overrides); }

std::string value_of(const Scene& scene, const char* key) { return value_text(*find_field(key, scene), scene).value(); }

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

TEST(Errors, FormAndStatus) {
  const Error error({"a.toml", 3, "run.until"}, "wrong type", "true", "give a number", Exit::io);
  EXPECT_STREQ(error.what(), "a.toml:3: run.until: wrong type (found true): give a number");
  EXPECT_EQ(error.status, Exit::io);
  EXPECT_EQ((Place{"--set", 0, "run.until"}.prefix()), "--set run.until: ");
  EXPECT_EQ((Place{}.prefix()), "");
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

class SceneFiles : public ProgramTest {};

TEST(Scene, LongTextsAreCutOffInMessages) {
  EXPECT_EQ(refusal(Exit::bad_input, [] { parse("law.type = '" + std::string(5000, 'a') + "'"); }),
            "s.toml:1: law.type: no such choice (found \"" + std::string(100, 'a') +
                "...\"): give one of inelastic, wet, sticky");
}

TEST(EffectiveScene, ReadsBackAsTheSameScene) {
  for (const EmbeddedFile& bundled : bundled_scenes()) {
    SCOPED_TRACE(bundled.name);
    expect_read_back(read_scene(std::string(bundled.name)));
  }
  EXPECT_FALSE(parse(good) == parse(good, {"law.restitution=0.9990000000000000000000000001"}));
  EXPECT_TRUE(parse(good) == parse(good, {"law.restitution=999e-3"}));
}

TEST_F(SceneFiles, EffectiveSceneHoldsTheParticlesOfAFileWithAllTheirDigits) {
  const std::string digits = "0.1234567890123456789012345678901234567890";
  write("b.csv", "x,v,m\n-1e-30,1," + digits + "\n" + digits + ",-1,2\n");
  const Scene scene =
      parse_scene("law.type = 'sticky'\nrun.until = 9\ninitial = { type = 'list', file = 'b.csv' }", path("s.toml"));
  expect_read_back(scene);
  EXPECT_FALSE(has(effective_toml(scene), "b.csv"));
  EXPECT_EQ(value_of(scene, "initial.x"), "[-1e-30, " + digits + "]");
  EXPECT_EQ(value_of(scene, "initial.m"), "[" + digits + ", 2]");
}

TEST(EffectiveScene, LongListsAreShownByTheirEnds) {
  std::string value = "[0";
  for (int k = 1; k < 1000; ++k) value += ", " + std::to_string(k);
  EXPECT_EQ(shortened(value + "]"), "[0, 1, ..., 999] (1000 values)");
  EXPECT_EQ(shortened("[1, 2, 3]"), "[1, 2, 3]");
}

TEST(EffectiveScene, ValuesThatDifferFromTheirDefaults) {
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(values(parse(good, {"initial.particles=8000.0", "initial.spacing=2"}), false),
            (Pairs{{"law.type", "\"inelastic\""},
                   {"law.restitution", "0.999"},
                   {"initial.type", "\"rows\""},
                   {"initial.spacing", "2"},
                   {"run.until", "6500"}}));
}

TEST(SceneKeys, AreAllDescribedWithTheirFacts) {
  const std::string manual = describe_fields();
  for (const Field& field : scene_fields()) EXPECT_TRUE(has(manual, std::string(field.key) + "  ("));
  EXPECT_TRUE(has(manual, "law.restitution  (number [0, 1], required)"));
  EXPECT_TRUE(has(manual, "law.cutoff  (number [0, inf), in l/t, default 0)"));
}

TEST(BundledScenes, HaveTheNamesOfTheirFiles) {
  Strings names;
  for (const EmbeddedFile& bundled : bundled_scenes()) names.emplace_back(bundled.name);
  EXPECT_TRUE(std::ranges::is_sorted(names));
  for (const auto& name : names) EXPECT_EQ(read_scene(name).name, std::filesystem::path(name).filename());
  EXPECT_NE(std::ranges::find(names, "classics/blast"), names.end());
}

TEST_F(SceneFiles, ComeBeforeBundledNames) {
  write("mine.toml", good);
  const Scene scene = read_scene(path("mine.toml"), {"run.until=7"});
  EXPECT_EQ(scene.name, "mine");
  EXPECT_EQ(scene.run.until.text, "7");
}

}  // namespace cradle::tools::scene_test
