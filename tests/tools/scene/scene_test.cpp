// Scenes as a user writes them: literals survive exactly, the effective scene reads back as the same scene
// (values.txt), ranges of times are lists of the doubles nearest to their decimals. Every key is given a value of every
// type that TOML has: what is not of the type of the key is refused with file, line and key, and nothing but a scene or
// such a refusal comes of any value. (The decimals: decimal_test.cpp, run/exact_test.cpp. What is refused, and with
// which message: tests/tools/messages.txt. Lists in files: outputs.txt.)
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

// ---- every key with values of every type

using Assignments = std::map<std::string, std::string>;

std::string text_of(const Assignments& scene) {
  std::string text;
  for (const auto& [key, value] : scene) text.append(key).append(" = ").append(value).append("\n");
  return text;
}

Scene parse(const Assignments& scene) { return parse_scene(text_of(scene), "s.toml"); }

Assignments with(const Assignments& scene, Assignments more) {
  more.insert(scene.begin(), scene.end());
  return more;
}

// Scenes that together have every row of the table.
std::vector<Assignments> scenes() {
  std::vector<Assignments> all;
  for (const tests::ListedCase& listed : tests::cases_in("scene/every_key.txt")) {
    Assignments& one = all.emplace_back();
    for (const std::string& line : listed.lines) {
      const auto equals = line.find(" = ");
      one.emplace(line.substr(0, equals), line.substr(equals + 3));
    }
  }
  return all;
}

// `key` with this value, in place of what the scene says of it.
Assignments with_value(Assignments scene, const std::string& key, const std::string& value) {
  std::erase_if(scene, [&](const auto& entry) { return entry.first == key || entry.first.starts_with(key + "."); });
  return with(scene, {{key, value}});
}

void expect_place(const std::string& message, const Assignments& scene, const std::string& key) {
  const auto line = 1 + std::distance(scene.begin(), scene.find(key));
  // A message on one of the keys of a table names this one.
  const std::regex place("^s\\.toml:" + std::to_string(line) + ": " + key + "[.a-z_]*: [^:]+: .+");
  EXPECT_TRUE(std::regex_search(message, place)) << message;
}

// Empty where the scene was taken.
std::string answer(const Assignments& scene, const std::vector<std::string>& settings = {}) {
  try {
    parse_scene(text_of(scene), "s.toml", settings);
    return "";
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an Error: " << error.what() << "\n" << text_of(scene) << testing::PrintToString(settings);
    return "";
  }
}

struct Wrong {
  const char *type, *value;  // the types that take it, or may
};
std::vector<Wrong> wrong_values() {
  const std::pair<const char*, std::vector<const char*>> of_types[] = {
      {"text", {"'a'", "''"}},
      {"number", {"5", "-2.5e3", "0x1F"}},
      {"text number", {"'5'"}},
      {"boolean", {"true", "false"}},
      {"numbers", {"[1, 2]"}},
      {"texts", {"['a']"}},
      {"numbers texts", {"[]", "['1', '2']"}},
      {"", {"[true]", "[1, 'a']", "[[]]", "[[1]]", "[['a'], 1]", "[{}]", "[{ a = 1 }]", "[1, {}]", "{}", "{ a = 1 }"}},
      {"", {"{ a.b.c = 1 }", "{ until = {} }", "{ every = [] }", "{ points = 'a' }", "{ points = { a = 1 } }"}},
      {"", {"{ every = 1979-05-27 }", "{ every = 1, from = true }", "{ every = 1, until = {} }"}},
      {"", {"{ points = 3, spacing = [1] }", "{ points = 3, spacing = 3 }", "nan", "[inf]"}},
      {"", {"1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "[1979-05-27]"}}};
  std::vector<Wrong> all;
  for (const auto& [type, values] : of_types)
    for (const char* value : values) all.push_back({type, value});
  return all;
}
const std::vector<Wrong> all_wrong = wrong_values();

std::string kind(const Field& field) {
  const auto type = type_name(field);
  if (type == "text" || type == "one of") return "text";
  if (type == "true or false") return "boolean";
  if (type.starts_with("list of numbers")) return "numbers";
  if (type.starts_with("list of texts")) return "texts";
  return "number";
}

// Calls of(field, scene) for every row of the table and a scene to which it applies.
template <class F> void for_each_row(const F& of) {
  const std::vector<Assignments> all = scenes();
  for (const Field& field : scene_fields()) {
    bool applied = false;
    for (const Assignments& scene : all) {
      Assignments plain = scene;
      if (plain.erase("initial.file") > 0) plain = with(plain, {{"initial.x", "[0]"}, {"initial.v", "[0]"}});
      if (!field.when->holds(parse(plain))) continue;
      applied = true;
      of(field, scene);
      break;
    }
    EXPECT_TRUE(applied) << field.key;
  }
}

bool may_be(const Wrong& wrong, const Field& field) {
  return has(std::string(" ") + wrong.type + " ", " " + kind(field) + " ");
}

TEST(WrongTypes, OfEveryKeyAreRefusedWithFileLineAndKey) {
  for_each_row([](const Field& field, const Assignments& scene) {
    for (const Wrong& wrong : all_wrong) {
      const Assignments given = with_value(scene, std::string(field.key), wrong.value);
      const std::string message = answer(given);
      if (!may_be(wrong, field)) expect_place(message, given, std::string(field.key));
    }
  });
}

// What is no table where there are only tables.
TEST(WrongTypes, OfEveryTableAreRefusedWithFileLineAndKey) {
  const Assignments scene = scenes().front();
  for (const Field& field : scene_fields())
    for (auto dot = field.key.find('.'); dot != field.key.npos; dot = field.key.find('.', dot + 1))
      for (const Wrong& wrong : all_wrong) {
        const std::string table(field.key.substr(0, dot)), value = wrong.value;
        if (value.starts_with('{')) continue;
        const Assignments given = with_value(scene, table, value);
        expect_place(answer(given), given, table);
      }
}

// The command line has no lines, and a bare word there is a text.
TEST(WrongTypes, OnTheCommandLineAreRefusedWithTheirKey) {
  for_each_row([](const Field& field, const Assignments& scene) {
    for (const Wrong& wrong : all_wrong) {
      const std::string setting = std::string(field.key) + "=" + wrong.value;
      const std::string message = answer(scene, {setting});
      if (may_be(wrong, field) || type_name(field) == "text") continue;
      EXPECT_TRUE(tests::begins(message, "--set " + std::string(field.key))) << setting;
    }
  });
}

}  // namespace cradle::tools::scene_test
