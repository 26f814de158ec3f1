// Scenes as a user writes them: literals survive exactly, and the effective scene reads back as the same scene
// (values.txt). What is refused, and with which message, is in tests/tools/messages.txt, lists in files are in
// outputs.txt.
#include "cradle/tools/scene/scene.hpp"

#include "cradle/tests/tools/cases.hpp"
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

}  // namespace cradle::tools::scene_test
