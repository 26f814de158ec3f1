// Scenes as a user writes them: literals survive exactly, every mistake has its own message with file, line and key,
// and the effective scene reads back as the same scene.
#include "cradle/tools/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tools::scene_test {

using test::begins;
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

// A message that ends in ... is the beginning of one.
void expect_message(const std::string& found, const std::string& key, const std::string& message) {
  const std::string expected = key.ends_with(' ') ? key + message : key + ": " + message;
  if (message.ends_with("..."))
    EXPECT_TRUE(begins(found, expected.substr(0, expected.size() - 3)));
  else
    EXPECT_EQ(found, expected);
}
struct Wrong {
  std::string scene;
  int line;  // 0: the file
  std::string key, message;
};
void expect_refused(const std::vector<Wrong>& scenes) {
  for (const auto& [scene, line, key, wrong] : scenes)
    expect_message(message(scene), (line == 0 ? "s.toml: " : "s.toml:" + std::to_string(line) + ": ") + key, wrong);
}
struct Overridden {
  std::string scene;
  struct Wrong {
    std::string settings, key, message;  // settings are separated by spaces
  };
  void expect_refused(const std::vector<Wrong>& all) const {
    for (const auto& [settings, key, wrong] : all) {
      std::istringstream words(settings);
      expect_message(message(scene, {std::istream_iterator<std::string>(words), {}}), "--set " + key, wrong);
    }
  }
};

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
  expect_refused({
      {line(2, ""), 0, "law.type", "missing: give one of inelastic, wet, sticky"},
      {line(3, ""), 0, "law.restitution", "missing: give a number from 0 to 1"},
      {line(5, ""), 0, "initial.type", "missing: give one of rows, ring, list, clusters, cold, gas"},
      {line(8, ""), 0, "run.until", "missing: give a number of run.start = 0 or more"},
      {"law.type = 'wet'\ninitial.type = 'ring'\nrun.until = 1", 0, "law.loss", "missing: give a number of 0 or more"},
  });
}

TEST(Scene, LiteralsAreKeptExactly) {
  const std::string digits(60, '9');
  EXPECT_EQ(parse(restitution("0." + digits)).law.restitution.text, "0." + digits);
  EXPECT_EQ(parse(restitution("0." + std::string(5000, '9') + " # many")).law.restitution.text.size(), 5002U);
  EXPECT_EQ(parse(restitution("\"0.999\"")).law.restitution.text, "0.999");
  EXPECT_EQ(parse(restitution("+0.99_9")).law.restitution.text, "0.999");
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
            "initial = { 'type' = 'list', x = [-1e-500, 0, 1.5], v = [ 1 , '1e-7' , 0x10 ] }");
  EXPECT_EQ(list.title, "é 1e-999, 1e-999");
  EXPECT_EQ(texts(list.initial.x), (Strings{"-1e-500", "0", "1.5"}));
  EXPECT_EQ(texts(list.initial.v), (Strings{"1", "1e-7", "16"}));
}

// However many digits it has, a number is one that TOML has too.
TEST(Scene, LongLiteralsAreTomlToo) {
  for (const char* wrong : {"0000000000000000.5", ".50000000000000000", "5.000000000000000e", "1__0.00000000000000",
                            "0_.50000000000000000", "1.e-400", ".5e-400", "--0.5000000000000000"})
    expect_refused({{restitution(wrong), 3, "", "not valid TOML..."}});
  EXPECT_EQ(parse(restitution("+0.500_000_000_000_000_1E-0_0")).law.restitution.text, "0.5000000000000001e-00");
}

// A number above 0 in the scene is above 0 in the run, and numbers that are always doubles are doubles that exist.
TEST(Scene, NumbersThatThePrecisionTakesFor0) {
  const std::string head = "law = { type = 'inelastic', restitution = 0.5 }\nrun.until = 1\n";
  const std::string rows = head + "initial = { type = 'rows', left = { particles = 2, speed = 1 }, "
                                  "right = { particles = 2, speed = -1 }, centre.mass = 1e-400 }\n";
  const std::string list = head + "initial = { type = 'list', x = [0, 1], v = [0, 0] }\n";
  const std::string mpfr = "run.precision = 'mpfr'\n", close = "1." + std::string(400, '0') + "1";
  for (const auto& [text, key] :
       {std::pair{rows, "initial.centre.mass"},
        {list + "run.stop_gap = 1e-400", "run.stop_gap"},
        {list + "output.series.every = 1e-400", "output.series.every"},
        {list + mpfr + "walls.left = { position = -1, temperature = 1e-400 }", "walls.left.temperature"}})
    EXPECT_TRUE(has(message(text), key + std::string(": too small for the precision (found 1e-400 with \"double\")")));
  EXPECT_EQ(parse(rows + "run.precision = 'mpfr'").initial.centre.mass.text, "1e-400");
  parse(list + mpfr + "run.stop_gap = 1e-400");
  for (const char* range : {"[1, 1.00000000000000000001]", "[-1e400, 1]"})
    EXPECT_TRUE(has(message(list + mpfr + "output.profiles.range = " + range), "not a range of doubles"));
  // A wall beside a particle by less than any binary number of a hundred digits resolves.
  parse(list + mpfr + "walls.right.position = " + close);
  EXPECT_TRUE(has(message(head + "initial = { type = 'list', x = [0, " + close +
                          "], v = [0, 0] }\nwalls.right.position = 1\n" + mpfr),
                  "a wall among the particles"));
}

TEST(Scene, IntegersMayBeWrittenAsFloats) {
  EXPECT_EQ(parse(line(6, "particles = 2e7")).initial.particles, 20000000U);
  EXPECT_EQ(parse(line(6, "particles = 8000.0")).initial.particles, 8000U);
  EXPECT_EQ(parse(line(6, "seed = 18446744073709551615")).initial.seed, std::numeric_limits<std::uint64_t>::max());
  const std::string even = ": give an even integer from 2 to 1e15";
  expect_refused({
      {line(6, "particles = 80.5"), 6, "initial.particles", "not an integer (found 80.5)" + even},
      {line(6, "particles = 8001"), 6, "initial.particles", "odd (found 8001)" + even},
      {line(6, "seed = 18446744073709551616"), 6, "initial.seed", "out of range (found 1844..."},
  });
}

TEST(Scene, MistakesAreReportedWithLineAndKey) {
  const std::string just_above = "1.00000000000000000000001", unit = ": give a number from 0 to 1",
                    law = ": give one of inelastic, wet, sticky", another = "key of another initial state (found ",
                    policy = "key of another collapse policy (found run.collapse = ";
  // Ranges are exact: these are within them.
  parse(restitution("1.0000000000000000000000"));
  parse(line(6, "perturbation = 0.49999999999999999999999"));
  parse(line(8, "until = 1e400\nprecision = \"float128\""));
  expect_refused({
      {restitution("1.5"), 3, "law.restitution", "out of range (found 1.5)" + unit},
      {restitution(just_above), 3, "law.restitution", "out of range (found " + just_above + ")" + unit},
      {restitution("-1e-400"), 3, "law.restitution", "out of range (found -1e-400)" + unit},
      {line(6, "perturbation = 0.5"), 6, "initial.perturbation",
       "out of range (found 0.5): give a number from 0 to below 0.5"},
      {line(6, "spacing = 0"), 6, "initial.spacing", "out of range (found 0): give a number above 0"},
      {good + "start = 7000", 8, "run.until", "out of range (found 6500): give a number of run.start = 7000 or more"},
      // numbers that are not finite
      {line(8, "until = inf"), 8, "run.until", "not finite (found inf): give a number of run.start = 0 or more"},
      {restitution("-nan"), 3, "law.restitution", "not finite (found -nan)" + unit},
      {restitution("\"nan\""), 3, "law.restitution", "not finite..."},
      {line(8, "until = 1e400"), 8, "run.until",
       "too large for the precision (found 1e400 with \"double\"): give a smaller number or another run.precision"},
      // wrong types
      {restitution("\"much\""), 3, "law.restitution", "wrong type (found \"much\")" + unit},
      {restitution("[1, 2]"), 3, "law.restitution", "wrong type (found an array of 2 values)" + unit},
      {restitution("{ value = 1 }"), 3, "law.restitution", "wrong type (found a table)" + unit},
      {restitution("true"), 3, "law.restitution", "wrong type (found true..."},
      {line(2, "type = 5"), 2, "law.type", "wrong type (found 5)" + law},
      {line(2, "type = \"dry\""), 2, "law.type", "no such choice (found \"dry\")" + law},
      {"title = 5\n" + good, 1, "title", "wrong type (found 5): give a text"},
      {"output = 5\n" + good, 1, "output", "wrong type (found 5)..."},
      {good + "[output]\nevents = 1", 10, "output.events", "wrong type (found 1): give true or false"},
      {good + "[output]\nsnapshots = 5", 10, "output.snapshots", "wrong type (found 5): gi..."},
      // an element is reported at its own line
      {good + "[output]\nsnapshots = [1,\n 2, true]", 11, "output.snapshots",
       "wrong type (found true): give a list of numbers from run.start = 0 to run.until = 6500, or a table {from, "
       "until, every}"},
      // unknown keys name the nearest known one
      {line(3, "restituton = 0.9"), 3, "law.restituton", "unknown key (found 0.9): did you mean law.restitution?"},
      {good + "restitution = 0.9", 9, "run.restitution", "unknown key (found 0.9): did you mean law.restitution?"},
      {good + "[otuput]\nevents = true", 10, "otuput.events", "unknown key (found true): did you mean output.events?"},
      {good + "[weather]\n", 9, "weather", "unknown key (found a table): remove it; the manual lists all keys"},
      // keys that do not apply
      {restitution("0.9\nloss = 1"), 4, "law.loss",
       "key of another law (found law.type = \"inelastic\"): remove it, it belongs to law.type = \"wet\""},
      {line(2, "type = \"sticky\""), 3, "law.restitution", "key of another law (found law.type = \"..."},
      // more helpful than the loss that is missing
      {line(2, "type = \"wet\""), 3, "law.restitution", "key of another law ..."},
      {line(6, "length = 10"), 6, "initial.length",
       another +
           "initial.type = \"rows\"): remove it, it belongs to initial.type = \"ring\" or initial.type = \"list\""},
      {line(5, "type = \"ring\"\nspeed = 1"), 6, "initial.speed", another + "initial.type = \"rin..."},
      {good + "digits = 50", 9, "run.digits",
       "key of another precision (found run.precision = \"double\"): remove it, it belongs to run.precision = "
       "\"mpfr\""},
      {good + "collapse = 'merge'\nmerge_speed = 1e-8\ncontact_time = 1", 11, "run.contact_time",
       policy + "\"merge\"): remove it, it belongs to run.collapse = \"contact-time\""},
      {good + "merge_speed = 1", 9, "run.merge_speed", "key of another collapse policy (f..."},
      {"law.type = 'sticky'\ninitial.type = 'rows'\n[run]\nuntil = 1\ncollapse = 'merge'\nmerge_speed = 1", 5,
       "run.collapse", "collapse policy of another law (found law.type = \"sticky\"): remove it, it belongs to ..."},
      {good + "collapse = 'cutoff'\nstop_gap = 1", 10, "run.stop_gap", "..."},
      {good + "collapse = 'contact-time'", 0, "run.contact_time", "missing: give a number above 0"},
      {good + "[output]\nseries = { points = 10, every = 1 }", 10, "output.series.points",
       "second way to say when the series is sampled (found output.series.every = 1): remove it, it belongs to a "
       "series without every and times"},
      {line(4, "[initial"), 4, "", "not valid TOML (f..."},
      {line(6, "type = 'rows'"), 6, "", "not valid TOML (f..."},
      {line(6, "particles = 1 2"), 6, "", "not valid TOML (f..."},
  });
}

TEST(Scene, TimesAreSortedAndWithinTheRun) {
  const Scene scene = parse(good + "start = -1\n[output]\nsnapshots = [6500, 1e3, 5, 1000.0, -1]\n"
                                   "series = { times = [3, 2] }\nprofiles = { times = [7], range = [-4, 4e1] }");
  EXPECT_EQ(texts(scene.output.snapshots), (Strings{"-1", "5", "1e3", "6500"}));
  EXPECT_EQ(texts(scene.output.series.times), (Strings{"2", "3"}));
  EXPECT_FALSE(scene.output.series.points);
  EXPECT_EQ(texts(scene.output.profiles.range), (Strings{"-4", "4e1"}));
  const std::string output = good + "[output]\n";
  expect_refused({
      {output + "snapshots = [1, 6500.001]", 10, "output.snapshots",
       "out of range (found 6500.001): give a list of numbers from run.start = 0 to run.until = 6500, or a table "
       "{from, until, every}"},
      {output + "series.times = []", 10, "output.series.times",
       "no times (found an empty list): give at least one time"},
      {output + "profiles.range = [4, -4]", 10, "output.profiles.range",
       "not a range (found from 4 to -4): give two positions, the lower one first"},
      {output + "profiles.range = [4]", 10, "output.profiles.range", "not a range (found an array of 1 ..."},
  });
}

TEST(Scene, RunCutShortOnTheCommandLineKeepsTheTimesWithinIt) {
  const std::string scene = good + "[output]\nsnapshots = [1, 50, 6000]\nprofiles.times = [6000]";
  EXPECT_EQ(texts(parse(scene, {"run.until=100"}).output.snapshots), (Strings{"1", "50"}));
  EXPECT_TRUE(parse(scene, {"run.until=100"}).output.profiles.times.empty());
  EXPECT_EQ(texts(parse(scene, {"run.until=100", "run.start=2"}).output.snapshots), (Strings{"50"}));
  Overridden{scene}.expect_refused({{"run.until=100 output.snapshots=[200]", "output.snapshots", "out of range..."}});
}

TEST(Scene, GeneralRows) {
  const std::string start = "law.type = 'sticky'\nrun.until = 9\n", head = start + "initial.type = 'rows'\n";
  const std::string left = "[initial.left]\nparticles = 3\nspeed = 1\n";
  const std::string right = "[initial.right]\nparticles = 5\nspeed = 0.5\ndensity = 2\n";
  const Scene scene = parse(head + left + right + "[initial.centre]\nmass = 4\nspeed = 0.75");
  EXPECT_TRUE(scene.initial.general_rows());
  EXPECT_EQ(scene.initial.left.particles, 3U);
  EXPECT_EQ(scene.initial.left.density.text, "1");
  EXPECT_EQ(scene.initial.right.density.text, "2");
  EXPECT_EQ(scene.initial.centre.mass.text, "4");
  expect_refused({
      {head + left, 0, "initial.right.particles", "missing: give an integer from 1 to 1e15"},
      {head + left + "[initial.right]\nparticles = 5\nspeed = 1.0", 9, "initial.right.speed",
       "the rows do not meet (found left row at 1, right row at 1.0): give the right row a lower velocity than the "
       "left row"},
      {head + left + right + "[initial.centre]\nmass = 1\nspeed = 2", 13, "initial.centre.speed",
       "a row does not reach the particle between the rows (found left row at 1, centre at 2, right row at 0.5): give "
       "a velocity between those of the rows"},
      {head + left + right + "[initial.centre]\nspeed = 2", 12, "initial.centre.speed", "..."},
      {head + "initial.particles = 8\n" + left + right, 4, "initial.particles",
       "key of another initial state (found initial.left.particles = 3): remove it, it belongs to initial.type = "
       "\"rows\" without [initial.left] and [initial.right] or initial.type = \"ring\" or initial.type = \"cold\" or "
       "initial.type = \"gas\""},
      {start + "initial.type = 'ring'\n" + left, 5, "initial.left.particles", "key of another initial st..."},
  });
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

  const std::string walls = three + "[walls]\n",
                    among = "a wall among the particles, which would have met before the start (found wall at ";
  expect_refused({
      {walls + "left.position = 0\nleft.temperature = 0", 6, "walls.left.temperature",
       "out of range (found 0): give a number above 0"},
      {walls + "left.position = 0\nleft.temperature = 1\nleft.restitution = 0.5", 7, "walls.left.restitution",
       "key of a wall that reflects (found walls.left.temperature = 1): remove it, it belongs to a left wall without "
       "temperature"},
      {walls + "right.speed = 1", 5, "walls.right.speed", "key of a wall that is not there..."},
      {walls + "left.position = 1", 5, "walls.left.position", among + "1, first particle at 1): move it outwards"},
      {walls + "right.position = 3", 5, "walls.right.position", among + "3, last particle at 4): move it outwards"},
      {rows + "walls.left.position = -7.5", 4, "walls.left.position", "a wall among the particles..."},
      {walls + "left.position = 0\nleft.speed = 0.25\nright.position = 4.5\nright.speed = -0.5", 6, "walls.left.speed",
       "the walls meet before the run ends (found at t = 7): give smaller speeds, or an earlier run.until"},
      {dry + "initial.type = 'ring'\nwalls.left.position = -1", 4, "walls.left.position",
       "a wall without a line of particles..."},
      {"law = { type = 'wet', loss = 1 }\nrun.until = 1\ninitial.type = 'rows'\nwalls.left.position = -1e5", 4,
       "walls.left.position", "key of another law..."},
  });
  EXPECT_TRUE(
      begins(message(three + "run.collapse = 'merge'\nrun.merge_speed = 1\nwalls.left.position = 0"), "s.toml:"));
}

TEST(Scene, RingIsAsLongAsItHasParticles) {
  const std::string text = "law.type = 'sticky'\nrun.until = 9\ninitial.type = 'ring'\ninitial.particles = 7\n";
  EXPECT_EQ(parse(text).initial.length.text, "7");
  EXPECT_EQ(parse(text + "initial.velocities = 'uniform'").initial.velocities, Velocities::uniform);
  EXPECT_EQ(parse(text + "initial.length = 1e-2").initial.length.text, "1e-2");
}

TEST(Scene, ParticlesInTheScene) {
  const std::string head = "law.type = 'sticky'\nrun.until = 9\n[initial]\ntype = 'list'\n";
  expect_refused({
      {head, 0, "initial.file",
       "missing: name a CSV file of particles, or give initial.x (or initial.gap) and initial.v"},
      {head + "file = 'b.csv'\nx = [1]", 5, "initial.file",
       "two lists of particles (found initial.file and initial.x): remove one of them"},
      {head + "x = [1, 2]\nv = [1]", 6, "initial.v", "not one per particle (found 1 for 2 positions): give 2 numbers"},
      {head + "x = [1, 2]", 0, "initial.v", "not one per particle (found 0 for 2 positions): give 2 numbers"},
      {head + "x = [1,\n 1.0]\nv = [2, 1]", 6, "initial.x",
       "particles that touch and approach (found 1.0 after 1): ..."},
      {head + "gap = []\nv = [2, 1]", 5, "initial.gap", "no gaps (found an empty list): ..."},
      {head + "x = [1, 2]\nv = [1, 2]\nm = [1, 0]", 7, "initial.m", "out of range (found 0..."},
      {head + "x = []\nv = []", 5, "initial.x", "no particles ..."},
      {head + "x = [1, 2]\nv = [1, 2]\nm = [1, 1e-400]", 7, "initial.m",
       "too small for the precision (found 1e-400 with \"double\"): give a larger number or another run.precision"},
  });
  EXPECT_EQ(parse(head + "x = [1, 2]\nv = [1, 2]\nm = [1, 1e-400]", {"run.precision=float128"}).initial.m[1], "1e-400");
}

const std::string small = "law.type = 'inelastic'\nlaw.restitution = 0.9\nrun.until = 10\ninitial.particles = 100\n",
                  ring = small + "initial.type = 'ring'\n", cold = small + "initial.type = 'cold'\n",
                  wet = "law.type=wet law.restitution= law.loss=1 ";

TEST(Scene, MassesRepeat) {
  EXPECT_TRUE(parse(ring).initial.masses.empty());
  EXPECT_EQ(texts(parse(ring, {"initial.masses=[1, 4.25]"}).initial.masses), (Strings{"1", "4.25"}));
  EXPECT_EQ(parse(good, {"initial.masses=[1,2,3]"}).initial.masses.size(), 3U);  // rows end with a part of the pattern
  const std::string indivisible = "the pattern does not divide the ring (found ",
                    multiple = "): give initial.particles as a multiple of ",
                    range = "): give a list of numbers above 0";
  expect_refused({
      {"[initial]\ntype = \"ring\"\nparticles = 7\nmasses = [1, 2]\n[law]\ntype = \"sticky\"\n[run]\nuntil = 1\n", 4,
       "initial.masses", indivisible + "2 masses, 7 particles" + multiple + "2"},
  });
  Overridden{good}.expect_refused({
      {"initial.masses=[1e-400]", "initial.masses", "..."},  // not in double
      {wet + "initial.masses=[1,2] output.zone.from=1", "output.zone.from",
       "for particles of mass 1 (found initial.masses of others)..."},
      {wet + "initial.masses=[2] output.scenario=true", "output.scenario",
       "for particles of mass 1 (found initial.masses of others)..."},
  });
  Overridden{ring}.expect_refused({
      {"initial.masses=[1,2,3]", "initial.masses", indivisible + "3 masses, 100 particles" + multiple + "3"},
      {"initial.masses=[]", "initial.masses", "no masses (found an empty list): give at least one mass"},
      {"initial.masses=[1,0]", "initial.masses", "out of range (found 0" + range},
      {"initial.masses=[1,-1]", "initial.masses", "out of range (found -1" + range},
  });
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
  const std::string range = "): give an integer from 1 to initial.particles = 100",
                    another = "key of another initial state (found initial.", remove = "): remove it, it belongs to ";
  Overridden{cold}.expect_refused({
      {"initial.hot=101", "initial.hot", "out of range (found 101" + range},
      {"initial.hot=0", "initial.hot", "out of range (found 0" + range},
      {"initial.energy=1", "initial.energy",
       another + "hot = 1" + remove + "initial.type = \"cold\" with several hot particles"},
      {"initial.hot=2 initial.speed=1", "initial.speed",
       another + "hot = 2" + remove +
           "initial.type = \"cold\" with initial.hot = 1 or initial.type = \"rows\" without [initial.left] and "
           "[initial.right] or initial.type = \"clusters\""},
      {"initial.hot=2 initial.energy=0", "initial.energy", "out of range (found 0): give a number above 0"},
  });
  Overridden{good}.expect_refused({
      {"initial.hot=2", "initial.hot", another + "type = \"rows\"" + remove + "initial.type = \"cold\""},
  });
}

TEST(Scene, RestitutionOfTheSpeed) {
  EXPECT_FALSE(parse(good, {"law.cutoff=1e-3"}).law.cutoff_exponent.has_value());
  EXPECT_EQ(parse(good, {"law.cutoff=1e-3", "law.cutoff_exponent=4"}).law.cutoff_exponent->text, "4");
  const std::string key = "law.cutoff_exponent", range = "): give a number above 0", cutoff = "law.cutoff=1e-3 ";
  Overridden{good}.expect_refused({
      {cutoff + "law.cutoff_exponent=0", key, "out of range (found 0" + range},
      {cutoff + "law.cutoff_exponent=-1", key, "out of range (found -1" + range},
      {"law.cutoff_exponent=4", key,
       "no cut-off that sets in (found law.cutoff = 0): give law.cutoff too, or remove this key"},
      {cutoff + "law.cutoff_exponent=4 run.collapse=merge run.merge_speed=1", "run.collapse",
       "not built with a restitution that depends on the speed (found \"merge\")..."},
      {wet + "law.cutoff_exponent=4", key, "key of another law..."},
  });
}

TEST(Scene, SamplesAreCountedBeforeMemoryForThemIsTaken) {
  Overridden{good}.expect_refused({
      {"output.series.every=1e-9", "output.series.every",
       "too many samples (found 1e-9, which makes 6.5e+12 of them until run.until): give a longer time, 1e+07 samples "
       "at most"},
      {"output.series.points=1e8", "output.series.points", "out of range (found 1e8): give an integer from 2 to 1e7"},
      {wet + "output.zone.from=1 output.zone.samples=1e8", "output.zone.samples", "out of range (found 1e8): ..."},
  });
  expect_refused({{good + "[output.series]\nevery = 1e-300", 10, "output.series.every", "too many samples..."}});
  EXPECT_EQ(parse(good, {"run.start=6499.9999999", "output.series.every=1e-9"}).output.series.every->text, "1e-9");
}

// How often a run is checkpointed cannot change its result, nor stand in it.
TEST(Scene, CheckpointsAreNoPartOfTheEffectiveScene) {
  const Scene often = parse(good + "[output]\ncheckpoint = { every_seconds = 0.5 }");
  EXPECT_EQ(often.output.checkpoint.every_seconds, tools::Decimal("0.5"));
  EXPECT_EQ(effective_toml(often), effective_toml(parse(good)));
  expect_refused({{good + "[output]\ncheckpoint = { every_seconds = -1 }", 10, "output.checkpoint.every_seconds",
                   "out of range (found -1): ..."}});
}

TEST(Scene, PointsAreSpreadOverATimeAndContinueBehindIt) {
  const std::string series = good + "[output]\nseries = { ", key = "output.series.over";
  EXPECT_EQ(parse(series + "points = 11, over = 100 }").output.series.over, tools::Decimal("100"));
  expect_refused({
      {series + "points = 11, over = 1e9 }", 10, key, "out of range (found 1e9): ..."},
      {series + "points = 11, over = 1e-9 }", 10, key, "too many samples (found 1e-9, ..."},
      {series + "every = 1, over = 100 }", 10, key, "second way to say when the series is sampled..."},
  });
}

class SceneFiles : public ProgramTest {};

TEST_F(SceneFiles, ResultsAreNoScenes) {
  write("a.h5", "\x89HDF\r\n\x1a\nand so on");
  EXPECT_EQ(refusal(Exit::bad_input, [&] { read_scene(path("a.h5")); }),
            path("a.h5") +
                ": a result, not a scene (found HDF5): give the scene file, or inspect it with `cradle info " +
                path("a.h5") + "`");
}

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

// A message is whole, and says what a terminal would do rather than show.
TEST(Scene, ControlCharactersAreWrittenOut) {
  expect_refused({
      {restitution("\"a\\u0000b\\u001B[2J\""), 3, "law.restitution",
       "wrong type (found \"a\\x00b\\x1b[2J\"): give a number from 0 to 1"},
      {line(3, "\"a\\u0000b\" = 1"), 3, "law.a\\x00b", "unknown key (found 1): remove it; the manual lists all keys"},
      {"title = \"a\\u0000b\"\n" + good, 1, "title", "a text with a character 0 (found \"a\\x00b\"): give a text"},
      {line(5, "type = \"list\"\nfile = \"a\\u0000b\""), 6, "initial.file", "a text with a character 0..."},
      {line(2, "type = \"" + std::string(5000, 'a') + "\""), 2, "law.type",
       "no such choice (found \"" + std::string(100, 'a') + "...\"): give one of inelastic, wet, sticky"},
  });
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

TEST(Overrides, ErrorsNameTheAssignment) {
  Overridden{good}.expect_refused({
      {"law.restitution=1.5", "law.restitution", "out of range (found 1.5): give a number from 0 to 1"},
      {"law.restituton=0.5", "law.restituton", "unknown key (found 0.5): did you mean law.restitution?"},
      {"run.until=soon", "run.until", "wrong type (found \"soon\"): ..."},
      {"output.snapshots=[1,9999]", "output.snapshots", "out of range (found ..."},
  });
  EXPECT_EQ(message(good, {"law.restitution"}),
            "--set: not an assignment (found law.restitution): write table.key=value");
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
  const std::string missing = refusal(Exit::io, [] { read_scene("fig99"); });
  EXPECT_EQ(missing, "fig99: no such scene (found neither a file nor a bundled scene): did you mean fig9?");
}

}  // namespace cradle::tools::scene_test
