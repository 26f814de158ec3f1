// Scenes as a user writes them: literals survive exactly, and the effective scene reads back as the same scene. What is
// refused, and with which message, is in tests/tools/messages.txt.
#include "cradle/tools/scene/scene.hpp"

#include <algorithm>
#include <limits>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::scene_test {

using test::has;
using tests::matches;
using tests::ProgramTest;
using tests::refusal;

const std::string good = R"([law]
type = "inelastic"
restitution = 0.999
[initial]
type = "rows"
particles = 8000
[run]
until = 6500
)";

// `good` with one line replaced (lines count from 1); text added to it starts at line 9, in [run].
std::string line(std::size_t number, const std::string& by) {
  std::string result, rest = good;
  for (std::size_t i = 1; !rest.empty(); ++i) {
    const auto end = rest.find('\n');
    result += (i == number ? by : rest.substr(0, end)) + '\n';
    rest.erase(0, end + 1);
  }
  return result;
}
std::string restitution(const std::string& value) { return line(3, "restitution = " + value); }

using Strings = std::vector<std::string>;

Scene parse(const std::string& text, const Strings& overrides = {}) { return parse_scene(text, "s.toml", overrides); }
std::string message(const std::string& text, const Strings& overrides = {}) {
  return refusal(Exit::bad_input, [&] { parse(text, overrides); });
}

Strings texts(const std::vector<Decimal>& numbers) {
  Strings result;
  for (const auto& number : numbers) result.push_back(number.text);
  return result;
}
Strings texts(const DecimalColumn& numbers) {
  Strings result;
  for (std::size_t i = 0; i < numbers.size(); ++i) result.emplace_back(numbers[i]);
  return result;
}

TEST(Errors, FormAndStatus) {
  const Error error({"a.toml", 3, "run.until"}, "wrong type", "true", "give a number", Exit::io);
  EXPECT_STREQ(error.what(), "a.toml:3: run.until: wrong type (found true): give a number");
  EXPECT_EQ(error.exit_code(), 4);
  EXPECT_EQ((Place{"--set", 0, "run.until"}.prefix()), "--set run.until: ");
  EXPECT_EQ((Place{}.prefix()), "");
}

TEST(Scene, DefaultsAreThoseOfTheTable) {
  const Scene scene = parse(good);
  EXPECT_EQ(scene.name, "s");
  EXPECT_EQ(scene.law.cutoff.text, "0");
  EXPECT_EQ(scene.initial.speed.text, "0.5");
  EXPECT_EQ(scene.initial.spacing, Decimal("1"));
  EXPECT_EQ(scene.initial.perturbation, Decimal("0"));
  EXPECT_EQ(scene.initial.seed, 1U);
  EXPECT_EQ(scene.initial.replica, 0U);
  EXPECT_FALSE(scene.initial.general_rows());
  EXPECT_EQ(scene.run.precision, Precision::double_);
  EXPECT_EQ(scene.run.coordinates, Coordinates::gaps);
  EXPECT_EQ(scene.run.collapse, scene::CollapsePolicy::stop);
  EXPECT_EQ(parse(good, {"law.cutoff=1e-5"}).run.collapse, scene::CollapsePolicy::cutoff);
  EXPECT_EQ(scene.output.series.points, 1000U);
  EXPECT_EQ(scene.output.profiles.bins, 50U);
  EXPECT_FALSE(scene.output.events);
}

TEST(Scene, OnlyTheContractsKeysAreRequired) {
  EXPECT_EQ(parse("law.type = 'sticky'\ninitial.type = 'rows'\nrun.until = 1\n").initial.particles, 8000U);
}

TEST(Scene, LiteralsAreKeptExactly) {
  const std::string digits(60, '9');
  EXPECT_EQ(parse(restitution("0." + digits)).law.restitution.text, "0." + digits);
  EXPECT_EQ(parse(restitution("0." + std::string(5000, '9') + " # many")).law.restitution.text.size(), 5002U);
  EXPECT_EQ(parse(restitution("\"0.999\"")).law.restitution.text, "0.999");
  EXPECT_EQ(parse(restitution("+0.99_9")).law.restitution.text, "0.999");
  EXPECT_EQ(parse(restitution("+0.500_000_000_000_000_1E-0_0")).law.restitution.text, "0.5000000000000001e-00");
  EXPECT_EQ(parse(restitution("'.5'")).law.restitution.text, "0.5");
  const Scene scene = parse(good + "start = -1_0.25E-1\nstop_gap = 1e-400\nprecision = 'mpfr'\n");
  EXPECT_EQ(scene.run.start.text, "-10.25e-1");
  EXPECT_EQ(scene.run.start.value, -1.025);
  ASSERT_TRUE(scene.run.stop_gap);
  EXPECT_EQ(scene.run.stop_gap->text, "1e-400");
  EXPECT_EQ(scene.run.stop_gap->value, 0.0);
  EXPECT_GT(*scene.run.stop_gap, Decimal("0"));
  // Other characters of several bytes before a literal on its line.
  const Scene list =
      parse("title = 'é 1e-999, 1e-999'\nlaw = { type = 'sticky' }\nrun = { until = 1, precision = 'float128' }\n"
            "initial = { 'type' = 'list', x = [-1e-500, 0, 1.5], v = [ 1 , '1e-7' , 0x10 ], m = [1, # heavy\n"
            "123456789012345678901, 1] }");
  EXPECT_EQ(list.title, "é 1e-999, 1e-999");
  EXPECT_EQ(texts(list.initial.x), (Strings{"-1e-500", "0", "1.5"}));
  EXPECT_EQ(texts(list.initial.v), (Strings{"1", "1e-7", "16"}));
  EXPECT_EQ(texts(list.initial.m), (Strings{"1", "123456789012345678901", "1"}));
}

// A number above 0 in the scene is above 0 in the run. A wall beside a particle by less than any binary number of a
// hundred digits resolves.
TEST(Scene, NumbersThatOnlyAWidePrecisionHolds) {
  const std::string head = "law = { type = 'inelastic', restitution = 0.5 }\nrun.until = 1\nrun.precision = 'mpfr'\n",
                    close = "1." + std::string(400, '0') + "1";
  EXPECT_EQ(parse(head + "initial = { type = 'rows', left = { particles = 2, speed = 1 }, "
                         "right = { particles = 2, speed = -1 }, centre.mass = 1e-400 }\n")
                .initial.centre.mass.text,
            "1e-400");
  parse(head + "initial = { type = 'list', x = [0, 1], v = [0, 0] }\nwalls.right.position = " + close);
  EXPECT_TRUE(
      has(message(head + "initial = { type = 'list', x = [0, " + close + "], v = [0, 0] }\nwalls.right.position = 1\n"),
          "a wall among the particles"));
}

TEST(Scene, IntegersMayBeWrittenAsFloats) {
  EXPECT_EQ(parse(line(6, "particles = 2e7")).initial.particles, 20000000U);
  EXPECT_EQ(parse(line(6, "particles = 8000.0")).initial.particles, 8000U);
  EXPECT_EQ(parse(line(6, "seed = 18446744073709551615")).initial.seed, std::numeric_limits<std::uint64_t>::max());
}

TEST(Scene, TimesAreSortedAndWithinTheRun) {
  const Scene scene = parse(good + "start = -1\n[output]\nsnapshots = [6500, 1e3, 5, 1000.0, -1]\n"
                                   "series = { times = [3, 2] }\nprofiles = { times = [7], range = [-4, 4e1] }");
  EXPECT_EQ(texts(scene.output.snapshots), (Strings{"-1", "5", "1e3", "6500"}));
  EXPECT_EQ(texts(scene.output.series.times), (Strings{"2", "3"}));
  EXPECT_FALSE(scene.output.series.points);
  EXPECT_EQ(texts(scene.output.profiles.range), (Strings{"-4", "4e1"}));
  EXPECT_EQ(parse(good + "[output]\nseries = { points = 11, over = 100 }").output.series.over, Decimal("100"));
  EXPECT_EQ(parse(good, {"run.start=6499.9999999", "output.series.every=1e-9"}).output.series.every->text, "1e-9");
}

TEST(Scene, RunCutShortOnTheCommandLineKeepsTheTimesWithinIt) {
  const std::string scene = good + "[output]\nsnapshots = [1, 50, 6000]\nprofiles.times = [6000]";
  EXPECT_EQ(texts(parse(scene, {"run.until=100"}).output.snapshots), (Strings{"1", "50"}));
  EXPECT_TRUE(parse(scene, {"run.until=100"}).output.profiles.times.empty());
  EXPECT_EQ(texts(parse(scene, {"run.until=100", "run.start=2"}).output.snapshots), (Strings{"50"}));
}

TEST(Scene, GeneralRows) {
  const Scene scene = parse("law.type = 'sticky'\nrun.until = 9\ninitial.type = 'rows'\n[initial.left]\n"
                            "particles = 3\nspeed = 1\n[initial.right]\nparticles = 5\nspeed = 0.5\ndensity = 2\n"
                            "[initial.centre]\nmass = 4\nspeed = 0.75");
  EXPECT_TRUE(scene.initial.general_rows());
  EXPECT_EQ(scene.initial.left.particles, 3U);
  EXPECT_EQ(scene.initial.left.density.text, "1");
  EXPECT_EQ(scene.initial.right.density.text, "2");
  EXPECT_EQ(scene.initial.centre.mass.text, "4");
}

TEST(Scene, WallsStandOutsideTheParticles) {
  const std::string dry = "law = { type = 'inelastic', restitution = 0.9 }\nrun = { until = 9, start = 1 }\n";
  const std::string three = dry + "initial = { type = 'list', x = [1, 2, 4], v = [0, 0, 0] }\n";
  const std::string rows = dry + "initial = { type = 'rows', particles = 8, perturbation = 0.25, spacing = 2 }\n";
  const Scene scene = parse(three + "[walls]\nleft.position = 0.5\nleft.temperature = 2\nright.position = 5\n"
                                    "right.speed = -0.1\nright.restitution = 0.75\n");
  EXPECT_EQ(scene.walls.left.temperature->text, "2");
  EXPECT_EQ(scene.walls.left.speed.text, "0");
  EXPECT_EQ(scene.walls.right.restitution.text, "0.75");
  EXPECT_EQ(parse(effective_toml(scene)), scene);
  EXPECT_FALSE(parse(three).walls.any());
  EXPECT_FALSE(parse(rows + "walls.left.position = -7.6").walls.right.position);
}

TEST(Scene, RingIsAsLongAsItHasParticles) {
  const std::string text = "law.type = 'sticky'\nrun.until = 9\ninitial.type = 'ring'\ninitial.particles = 7\n";
  EXPECT_EQ(parse(text).initial.length.text, "7");
  EXPECT_EQ(parse(text + "initial.velocities = 'uniform'").initial.velocities, Velocities::uniform);
  EXPECT_EQ(parse(text + "initial.length = 1e-2").initial.length.text, "1e-2");
}

TEST(Scene, MassesBelowTheRangeOfDouble) {
  const std::string head = "law.type = 'sticky'\nrun.until = 9\n[initial]\ntype = 'list'\n";
  EXPECT_EQ(parse(head + "x = [1, 2]\nv = [1, 2]\nm = [1, 1e-400]", {"run.precision=float128"}).initial.m[1], "1e-400");
}

const std::string small = "law.type = 'inelastic'\nlaw.restitution = 0.9\nrun.until = 10\ninitial.particles = 100\n",
                  ring = small + "initial.type = 'ring'\n", cold = small + "initial.type = 'cold'\n";

TEST(Scene, MassesRepeat) {
  EXPECT_TRUE(parse(ring).initial.masses.empty());
  EXPECT_EQ(texts(parse(ring, {"initial.masses=[1, 4.25]"}).initial.masses), (Strings{"1", "4.25"}));
  EXPECT_EQ(parse(good, {"initial.masses=[1,2,3]"}).initial.masses.size(), 3U);  // rows end with a part of the pattern
  EXPECT_TRUE(unequal_masses(parse(good, {"initial.masses=[1,2]"})));
  EXPECT_TRUE(unequal_masses(parse(good, {"initial.masses=[2]"})));
  EXPECT_FALSE(unequal_masses(parse(good, {"initial.masses=[1,1.0]"})));
}

TEST(Scene, ColdGas) {
  const Scene one = parse(cold);
  EXPECT_EQ(one.initial.hot, 1U);
  EXPECT_EQ(one.initial.place, scene::HotPlace::middle);
  EXPECT_EQ(one.initial.speed.text, "1");
  EXPECT_EQ(one.initial.spacing.text, "1");
  const Scene many = parse(cold, {"initial.hot=32", "initial.place=left"});
  EXPECT_EQ(many.initial.energy.text, "32");  // one each
  EXPECT_EQ(many.initial.place, scene::HotPlace::left);
}

TEST(Scene, RestitutionOfTheSpeed) {
  EXPECT_FALSE(parse(good, {"law.cutoff=1e-3"}).law.cutoff_exponent.has_value());
  EXPECT_EQ(parse(good, {"law.cutoff=1e-3", "law.cutoff_exponent=4"}).law.cutoff_exponent->text, "4");
}

// How often a run is checkpointed cannot change its result, nor stand in it.
TEST(Scene, CheckpointsAreNoPartOfTheEffectiveScene) {
  const Scene often = parse(good + "[output]\ncheckpoint = { every_seconds = 0.5 }");
  EXPECT_EQ(often.output.checkpoint.every_seconds, tools::Decimal("0.5"));
  EXPECT_EQ(effective_toml(often), effective_toml(parse(good)));
}

class SceneFiles : public ProgramTest {};

// What is no file is neither waited for nor read without end, whatever command it is given to.
TEST_F(SceneFiles, AreFiles) {
  write("list.toml", "law.type = 'sticky'\nrun.until = 1\ninitial = { type = 'list', file = 'fifo' }\n");
  shell("mkfifo fifo && mkdir out && mkfifo out/files.txt && cradle run collapse3 --quiet -o a.h5", 3);
  for (const char* command :
       {"check fifo", "run fifo", "run /dev/zero", "ensemble fifo --replicas 2", "sweep fifo", "trust fifo",
        "certify fifo", "threshold fifo --vary law.restitution=0:1", "theory fifo", "new b.toml --from fifo",
        "run list.toml", "run list.toml --set initial.file=/dev/zero", "info fifo", "export fifo --to csv",
        "diff fifo a.h5", "merge fifo a.h5 -o b.h5", "resume fifo"}) {
    const tests::Printed refused = shell(std::string("timeout 20 cradle ") + command, 4);
    EXPECT_TRUE(matches(refused.err, "(fifo|zero): [^:]+ \\(found [^:]*(?:FIFO|device)[^:]*\\): .+").size() == 1)
        << command << "\n"
        << refused.err;
  }
  EXPECT_TRUE(has(shell("timeout 20 cradle export a.h5 --to out", 2).err, "a folder with other files"));
  // A file that is given as another one is not shown.
  write("secret", "root:$6$abcdef:19000:0:99999:7:::\nsecond,line\n");
  for (const char* command : {"run list.toml --set initial.file=secret", "run secret", "info secret"})
    EXPECT_FALSE(has(shell(std::string("cradle ") + command).err, "abcdef")) << command;
}

TEST(Scene, LongTextsAreCutOffInMessages) {
  EXPECT_EQ(message(line(2, "type = \"" + std::string(5000, 'a') + "\"")),
            "s.toml:2: law.type: no such choice (found \"" + std::string(100, 'a') +
                "...\"): give one of inelastic, wet, sticky");
}

TEST(Overrides, ReplaceAddAndRemove) {
  const Scene scene =
      parse(good, {"law.restitution=0.5", "run.precision=long double", "initial.replica = 17",
                   "output.series={ points = 10, spacing = \"log\" }", "title=2026", "run.stop_gap=1e-4000"});
  EXPECT_EQ(scene.law.restitution.text, "0.5");
  EXPECT_EQ(scene.run.precision, Precision::long_double);
  EXPECT_EQ(scene.initial.replica, 17U);
  EXPECT_EQ(scene.output.series.points, 10U);
  EXPECT_EQ(scene.output.series.spacing, Spacing::log);
  EXPECT_EQ(scene.title, "2026");
  EXPECT_EQ(scene.run.stop_gap->text, "1e-4000");
  EXPECT_EQ(parse(good, {"law.type=wet", "law.restitution=", "law.loss=0.1"}).law.type, LawType::wet);
  // The series has one way of sampling: the last one wins.
  const Scene every = parse(good + "[output]\nseries = { points = 5, spacing = 'log' }", {"output.series.every=0.5"});
  EXPECT_FALSE(every.output.series.points);
  EXPECT_EQ(every.output.series.every->text, "0.5");
}

TEST(EffectiveScene, ReadsBackAsTheSameScene) {
  const std::vector<std::string> scenes = {
      good,
      good +
          "collapse = 'contact-time'\ncontact_time = 1e-6\nprecision = 'mpfr'\ndigits = 77\n[output]\nevents = true\n",
      "title = \"a \\\"quoted\\\" \\\\ name\\twith é\"\nlaw = {type = 'wet', loss = 1e-4}\ninitial = {type = 'ring', "
      "seed = '18446744073709551615'}\n"
      "run = {until = 1e400, precision = 'float128'}\noutput.series.every = '.5e399'",
      "law.type = 'sticky'\nrun.until = 5\ninitial = {type = 'rows', left = {particles = 2, speed = 1}, right = "
      "{particles = 1, speed = -1}}"};
  for (const auto& text : scenes) {
    const Scene scene = parse(text);
    const std::string effective = effective_toml(scene);
    const Scene again = parse_scene(effective, "elsewhere/t.toml");
    EXPECT_TRUE(again == scene) << effective;
    EXPECT_EQ(effective_toml(again), effective);
  }
  for (const BundledScene& bundled : bundled_scenes()) {
    const Scene scene = read_scene(std::string(bundled.name));
    EXPECT_TRUE(parse(effective_toml(scene)) == scene) << bundled.name;
  }
  EXPECT_FALSE(parse(good) == parse(good, {"law.restitution=0.9990000000000000000000000001"}));
  EXPECT_TRUE(parse(good) == parse(good, {"law.restitution=999e-3"}));
}

TEST_F(SceneFiles, EffectiveSceneHoldsTheParticlesOfAFileWithAllTheirDigits) {
  const std::string digits = "0.1234567890123456789012345678901234567890";
  write("b.csv", "x,v,m\n-1e-30,1," + digits + "\n" + digits + ",-1,2\n");
  const Scene scene =
      parse_scene("law.type = 'sticky'\nrun.until = 9\ninitial = { type = 'list', file = 'b.csv' }", path("s.toml"));
  const std::string effective = effective_toml(scene);
  EXPECT_FALSE(has(effective, "b.csv"));
  const Scene again = parse_scene(effective, "elsewhere/t.toml");
  EXPECT_TRUE(again == scene) << effective;
  EXPECT_EQ(texts(again.initial.x), (Strings{"-1e-30", digits}));
  EXPECT_EQ(texts(again.initial.m), (Strings{digits, "2"}));
}

TEST(EffectiveScene, LongListsAreShownByTheirEnds) {
  std::string value = "[0";
  for (int k = 1; k < 1000; ++k) value += ", " + std::to_string(k);
  EXPECT_EQ(shortened(value + "]"), "[0, 1, ..., 999] (1000 values)");
  EXPECT_EQ(shortened("[1, 2, 3]"), "[1, 2, 3]");
}

TEST(EffectiveScene, ValuesThatDifferFromTheirDefaults) {
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(values(parse(line(6, "particles = 8000.0\nspacing = 2")), false), (Pairs{{"law.type", "\"inelastic\""},
                                                                                     {"law.restitution", "0.999"},
                                                                                     {"initial.type", "\"rows\""},
                                                                                     {"initial.spacing", "2"},
                                                                                     {"run.until", "6500"}}));
  const auto all = values(parse(good), true);
  EXPECT_NE(std::ranges::find(all, std::pair<std::string, std::string>("output.series.points", "1000")), all.end());
  for (const auto& [key, value] : all) EXPECT_NE(key, "law.loss");
}

TEST(SceneKeys, AreAllDescribedWithTheirFacts) {
  const std::string manual = describe_fields();
  for (const Field& field : scene_fields()) EXPECT_TRUE(has(manual, std::string(field.key) + "  ("));
  EXPECT_TRUE(has(manual, "law.restitution  (number [0, 1], required)"));
  EXPECT_TRUE(has(manual, "law.cutoff  (number [0, inf), in l/t, default 0)"));
}

TEST(BundledScenes, HoldThePapersParameters) {
  Strings names;
  for (const BundledScene& bundled : bundled_scenes()) names.emplace_back(bundled.name);
  EXPECT_TRUE(std::ranges::is_sorted(names));
  for (const char* name : {"fig2", "fig3", "fig4", "collapse3"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  for (const auto& name : names) EXPECT_EQ(read_scene(name).name, std::filesystem::path(name).filename());
  EXPECT_NE(std::ranges::find(names, "classics/blast"), names.end());
  for (const char* name : {"fig2", "fig3", "fig4"}) {
    const Scene scene = read_scene(name);
    EXPECT_EQ(scene.law.restitution.text, "0.999");
    EXPECT_EQ(scene.law.cutoff.text, "1e-5");
    EXPECT_EQ(scene.initial.particles, 8000U);
    EXPECT_EQ(scene.initial.speed.text, "0.5");
    EXPECT_EQ(scene.run.until.text, "6500");
  }
  EXPECT_EQ(texts(read_scene("fig3").output.snapshots), (Strings{"6500"}));
  const Scene collapse = read_scene("collapse3");
  EXPECT_EQ(texts(collapse.initial.x), (Strings{"0", "1", "3"}));
  EXPECT_EQ(texts(collapse.initial.v), (Strings{"1", "0", "-1"}));
  EXPECT_EQ(collapse.run.collapse, scene::CollapsePolicy::stop);
}

TEST_F(SceneFiles, ComeBeforeBundledNames) {
  write("mine.toml", good);
  const Scene scene = read_scene(path("mine.toml"), {"run.until=7"});
  EXPECT_EQ(scene.name, "mine");
  EXPECT_EQ(scene.run.until.text, "7");
}

}  // namespace cradle::tools::scene_test
