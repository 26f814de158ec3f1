// Runs that are stopped anywhere and resumed end in the bytes of an uninterrupted run: law x scalar type x coordinates
// x initial state x policy x threads x where it is cut.
#include <csignal>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cradle/precision/scalars.hpp"
#include "cradle/tests/tools/store/stopping.hpp"
#include "cradle/tools/result/reader.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace resume_test {

using namespace cradle::tools;
using cradle::tests::contents;
using cradle::tests::Stopping;

// Keeps back how the run ended, so that its file is not written.
class Unwritten final : public Stopping {
 public:
  using Stopping::Stopping;
  bool due() const override { return files_.due(); }
  void end(std::vector<Attribute>&& attributes, RunEnd) override { attributes_ = std::move(attributes); }
  void write(RunFiles& files) { files.end(std::move(attributes_), RunEnd::reached); }

 private:
  std::vector<Attribute> attributes_;
};

struct Case {
  const char* name;
  std::string scene;
  std::vector<std::string> precisions = {"double", "long double", "double-double", "cpp_bin_float", "float128", "mpfr"};
  std::size_t threads = 1, threads_later = 1;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::string outputs_and(const std::string& more) {
  return "output = { series.points = 20, snapshots = [40, 60], profiles = { times = [50], bins = 8 }, events = true, "
         "averages = { every = 2.5, bins = 4, range = [-50, 50] }, histograms = ['free_flight', 'closing_speed', "
         "'dissipative_closing_speed', 'collisions_per_particle', 'gap', 'cluster'], " +
         more +
         "structure = { every = 7, times = [30, 80], waves = 20, length = 15 }, "
         "counting = { from = 10, until = 90, every = 20, cluster_gap = 0.5, range = [1e-3, 10] } }\n";
}
const std::string outputs = outputs_and("");

std::string dry(const std::string& initial, const std::string& run, const std::string& law = "") {
  std::string more;
  if (!cradle::tests::has(run, "merge")) more += "correlations = { every = 1.5, from = 5, tag_every = 2 }, ";
  if (cradle::tests::has(initial, "'ring'")) more += "pair_distribution = { every = 7, times = [45], distance = 9 }, ";
  return "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-4 }\n" + initial + outputs_and(more) + law +
         "[run]\nuntil = 100\n" + run;
}

const std::string rows = "initial = { type = 'rows', particles = 80, perturbation = 0.05 }\n";
const std::string ring = "initial = { type = 'ring', particles = 30, perturbation = 0.1 }\n";
const std::string list = "initial = { type = 'list', x = [0, 1, 3, 4, 7, 8.5], v = [1, 0.5, -1, 2, -1, -2], "
                         "m = [1, 2, 1, 3, 1, 0.5] }\n";
const std::string general =
    "initial = { type = 'rows', left = { particles = 40, speed = 1 }, right = { particles = 30, "
    "speed = -0.5, density = 2 }, centre = { mass = 5, speed = 0.1 }, perturbation = 0.1 }\n";
const std::string between_walls = "[walls]\nleft = { position = -60, temperature = 0.4 }\nright = { position = 50, "
                                  "speed = -0.05, restitution = 0.9 }\n";
const std::string on_a_floor =
    "[gravity]\nacceleration = -0.03\n[walls]\nleft = { position = -60, restitution = 0.9 }\n";
const std::string wet = "law = { type = 'wet', loss = 0.01 }\n", sticky = "law.type = 'sticky'\n";
const std::string watched =
    "output = { series = { points = 300, spacing = 'log' }, masses = [10, 100], scenario = true, "
    "zone = { from = 20, samples = 32 }, core = true }\n";
const std::string to_100 = "[run]\nuntil = 100\n";

const std::string of_2500 = "particles = 2500, perturbation = 0.1 }\n",
                  large_dry = "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-3 }\n"
                              "initial = { type = 'ring', " +
                              of_2500,
                  large_walls = "law = { type = 'inelastic', restitution = 0.95, cutoff = 0.05 }\n"
                                "walls = { left = { position = -1252, speed = 0.8 }, "
                                "right = { position = 1252, temperature = 1 } }\ninitial = { type = 'rows', " +
                                of_2500,
                  large_wet = wet + "initial = { type = 'ring', " + of_2500, to_8 = "run.until = 8\n",
                  few = "output = { series.points = 12, profiles = { times = [5], bins = 8 }, histograms = "
                        "['free_flight'] }\n" +
                        to_8,
                  tagged = "output = { series.points = 12, correlations.every = 0.2, structure = { every = 2, waves = "
                           "20 }, pair_distribution = { every = 2, distance = 3 } }\n" +
                           to_8,
                  events = "output = { series.points = 5, events = true }\n" + to_8;

const std::string at_contact_time = "collapse = 'contact-time'\ncontact_time = 1e-3\n",
                  absolute = "coordinates = 'absolute'\n", merging = "collapse = 'merge'\nmerge_speed = 0.01\n";

// Scenes in six types, four cuts each with another one behind it.
const Case cases[] = {
    {"DryRows", dry(rows, "")},
    {"DryRowsPositions", dry(rows, absolute)},
    {"ContactTime", dry(rows, at_contact_time)},
    {"ContactTimePositions", dry(rows, at_contact_time + absolute)},
    {"Merging", dry(rows, merging)},
    {"DryRing", dry(ring, "")},
    {"MergingRing", dry(ring, merging)},
    {"DryList", dry(list, "")},
    {"ContactTimeList", dry(list, at_contact_time)},
    {"GeneralRows", dry(general, "start = -3.5")},
    {"WetRows", wet + rows + watched + to_100},
    {"WetRing", wet + ring + outputs + to_100},
    {"WetGeneralRows", wet + general + outputs + to_100},
    {"StickyCollisions", sticky + rows + outputs + to_100},
    // From time to time, without collisions.
    {"Sticky", sticky + rows + "output.series.points = 40\noutput.masses = [30]\n" + to_100},
    {"StickyRing", sticky + ring + "output.series.points = 40\n" + to_100},
    {"Collapse", "law = { type = 'inelastic', restitution = 0.05 }\ninitial = { type = 'list', x = [0, 1, 3, 10], v = "
                 "[1, 0, -1, 5] }\noutput.series.points = 30\n" +
                     to_100 + "collapse = 'stop'\n"},
    {"Walls", dry(list, between_walls)},
    {"WallsPositions", dry(rows, absolute + between_walls)},
    {"WallsContactTime", dry(rows, at_contact_time + between_walls)},
    {"PatternRows",
     dry("initial = { type = 'rows', particles = 80, perturbation = 0.05, masses = [1, 4.2, 2] }\n", "")},
    {"PatternRing", dry("initial = { type = 'ring', particles = 30, perturbation = 0.1, masses = [1, 4.2] }\n", "")},
    {"Cold", dry("initial = { type = 'cold', particles = 300, hot = 6, energy = 8, masses = [1, 2], perturbation = 0.2 "
                 "}\n",
                 "")},
    {"ColdPositions", dry("initial = { type = 'cold', particles = 300, place = 'left', speed = 2, masses = [4.2, 1] "
                          "}\n",
                          absolute)},
    {"SpeedDependent", "law = { type = 'inelastic', restitution = 0.95, cutoff = 1e-2, cutoff_exponent = 3.5 }\n" +
                           rows + outputs + to_100},
    {"Gravity", dry(list, on_a_floor)},
    {"GravityPositions", dry(list, absolute + on_a_floor)},
    {"GravityContactTime", dry(list, at_contact_time + "[gravity]\nacceleration = 0.03\n" + between_walls)},
    {"LargeWalls", large_walls + few, {"double", "double-double"}, 2, 3},
    {"LargeDry", large_dry + few, {"double", "double-double"}, 1, 1},
    {"LargeDryTagged", large_dry + tagged, {"double", "double-double"}, 2, 1},
    {"LargeDryFromTwoThreadsToOne", large_dry + few, {"double", "long double", "mpfr"}, 2, 1},
    {"LargeDryFromOneThreadToThree", large_dry + few, {"double", "float128"}, 1, 3},
    {"LargeWetFromThreeThreadsToTwo", large_wet + few, {"double", "double-double"}, 3, 2},
    {"LargeWallsEvents", large_walls + events, {"double"}, 2, 3},
    {"LargeDryEvents", large_dry + events, {"double", "double-double"}, 2, 1},
    {"LargeWetEvents", large_wet + events, {"double"}, 1, 3},
};

class Resuming : public cradle::tests::ProgramTest {
 protected:
  std::string file(const std::string& name) const { return path(name); }

  // Returns how it ended; FILE is there if it did.
  static RunOutcome run(RunFiles& files, Stopping::At at, std::size_t threads) {
    Interrupt interrupt;
    Stopping store(files, interrupt, at);
    cradle::Workers workers;  // one after the other, as many as required
    workers.count = threads;
    return run_scene(files.scene(), {Progress::Show::never, nullptr, &interrupt, workers}, store);
  }

  RunOutcome begin(const char* name, const Scene& scene, Stopping::At at, std::size_t threads) const {
    RunFiles files(file(name), scene);
    return run(files, at, threads);
  }
  RunOutcome resume(const char* name, const std::optional<std::string>& until, Stopping::At at,
                    std::size_t threads) const {
    RunFiles files(file(name), until);
    return run(files, at, threads);
  }
  // The bytes are those of the file's own scene, run from the beginning.
  void expect_as_in_one_go(const char* name) const {
    begin("alone.h5", scene_in(read_result(file(name)).attributes, file(name)), {}, 1);
    EXPECT_TRUE(contents(file("alone.h5")) == contents(file(name))) << "other bytes";
  }
};

class Resume : public Resuming, public testing::WithParamInterface<Case> {};

TEST_P(Resume, EndsInTheSameBytesWhereverItIsCut) {
  const Case& of = GetParam();
  for (const std::string& precision : of.precisions) {
    SCOPED_TRACE(precision);
    std::vector<std::string> set{"run.precision=" + precision};
    if (precision == "mpfr") set.push_back("run.digits=60");
    const Scene scene = parse_scene(of.scene, "scene.toml", set);
    try {
      check_built(scene);
    } catch (const Error&) {
      continue;
    }
    const RunOutcome whole = begin("alone.h5", scene, {}, of.threads_later);
    const std::string wanted = contents(file("alone.h5"));
    ASSERT_GT(whole.collisions, 4U);
    for (const Stopping::At at : {Stopping::At{.collisions = 1},
                                  {.collisions = whole.collisions / 3},
                                  {.collisions = 4 * whole.collisions / 5},
                                  {.checks = 7}}) {
      SCOPED_TRACE(testing::Message() << "collisions " << at.collisions << ", looks " << at.checks);
      const RunOutcome cut = begin("cut.h5", scene, at, of.threads);
      if (cut.end == RunEnd::interrupted) {
        EXPECT_FALSE(std::filesystem::exists(file("cut.h5")));
        const Stopping::At half{.collisions = cut.collisions + (whole.collisions - cut.collisions) / 2};
        if (resume("cut.h5", std::nullopt, half, of.threads_later).end == RunEnd::interrupted) {
          EXPECT_EQ(resume("cut.h5", std::nullopt, {}, of.threads_later).end, whole.end);
        }
      }
      EXPECT_TRUE(contents(file("cut.h5")) == wanted) << "other bytes";
      EXPECT_FALSE(std::filesystem::exists(file("cut.h5.part")));
      std::filesystem::remove(file("cut.h5"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, Resume, testing::ValuesIn(cases),
                         [](const auto& of) { return std::string(of.param.name); });

// ---- extended

// A checkpoint at every sample, on any machine.
constexpr const char* from_the_start = "output.checkpoint.every_seconds=1e-9";

TEST_F(Resuming, ALaterEndGivesTheBytesOfASceneThatHadItFromTheBeginning) {
  const std::string inelastic = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n";
  const char* every[] = {"every = 0.7", "points = 21", "points = 60, spacing = 'log'", "times = [1, 2, 9]"};
  for (const char* series : every) {
    for (const std::string& law : {wet, sticky, inelastic}) {
      for (const std::string& initial : {rows, general}) {
        SCOPED_TRACE(law + initial + series);
        const char* precision = series == every[1] ? "double-double" : "double";  // there with decimals beside
        const Scene scene =
            parse_scene(law + initial + "output = { series = { " + series + " }, snapshots = [5], core = true, " +
                            "averages = { every = 0.3, range = [-9, 9] }, histograms = ['free_flight'], " +
                            "structure = { every = 0.7, times = [4], waves = 9, length = 9 }, " +
                            (law == inelastic ? "correlations.every = 0.3, " : "") +
                            "events = " + (law == sticky ? "false" : "true") + " }\nrun.until = 10\n",
                        "scene.toml", {std::string("run.precision=") + precision});
        ASSERT_EQ(begin("later.h5", scene, {}, 1).end, RunEnd::reached);
        // Which is resumed as any other.
        if (resume("later.h5", "13.05", {.checks = 2}, 1).end == RunEnd::interrupted) {
          ASSERT_EQ(resume("later.h5", std::nullopt, {}, 1).end, RunEnd::reached);
        }
        ASSERT_EQ(resume("later.h5", "60", {}, 1).end, RunEnd::reached);

        EXPECT_EQ(scene_in(read_result(file("later.h5")).attributes, "later.h5").run.until, Decimal("60"));
        expect_as_in_one_go("later.h5");
        std::filesystem::remove(file("later.h5"));
      }
    }
  }
}

// A run that was over before it had anything to lose has left no checkpoint: it is run again, to a later end.
TEST_F(Resuming, WithoutACheckpointALaterEndIsRunFromTheStart) {
  const Scene scene = parse_scene(dry(rows, ""), "scene.toml", {"output.checkpoint.every_seconds=0"});
  begin("a.h5", scene, {}, 1);
  std::filesystem::remove(file("a.h5.checkpoint"));  // of a machine so slow that the run took two seconds
  EXPECT_EQ(RunFiles(file("a.h5"), "120").resumed_from(), "the start");
  ASSERT_EQ(resume("a.h5", "120", {}, 1).end, RunEnd::reached);
  expect_as_in_one_go("a.h5");
}

// An extension whose journal has no checkpoint yet begins again from the result and its checkpoint.
TEST_F(Resuming, AnExtensionStoppedBeforeItsFirstCheckpointBeginsAgain) {
  const Scene scene = parse_scene(dry(rows, ""), "scene.toml", {from_the_start});
  begin("a.h5", scene, {}, 1);
  const std::string checkpoint = contents(file("a.h5.checkpoint"));
  ASSERT_EQ(resume("a.h5", "120", {.checks = 2}, 1).end, RunEnd::interrupted);
  { std::ofstream(file("a.h5.checkpoint"), std::ios::binary) << checkpoint; }  // as a kill before it was written
  EXPECT_NE(RunFiles(file("a.h5"), std::nullopt).resumed_from(), "the start");
  ASSERT_EQ(resume("a.h5", std::nullopt, {}, 1).end, RunEnd::reached);
  expect_as_in_one_go("a.h5");
}

// Whether there is a journal, and from when on, changes nothing in the result.
TEST_F(Resuming, ARunThatHasNothingToLoseWritesItsFileAlone) {
  for (const char* every : {"0", "1e-9"}) {
    const Scene scene =
        parse_scene(dry(rows, ""), "scene.toml", {std::string("output.checkpoint.every_seconds=") + every});
    const std::string name = std::string("a") + every + ".h5";
    RunFiles files(file(name), scene);
    Interrupt interrupt;
    Unwritten sink(files, interrupt, {});
    run_scene(scene, {Progress::Show::never, nullptr, &interrupt}, sink);
    EXPECT_EQ(std::filesystem::exists(file(name + ".part")), files.up_to_date());
    if (*every == '1') {
      EXPECT_TRUE(files.up_to_date());
    }
    sink.write(files);
    EXPECT_FALSE(std::filesystem::exists(file(name + ".part")));
  }
  EXPECT_TRUE(contents(file("a0.h5")) == contents(file("a1e-9.h5"))) << "other bytes";
}

// What is tabled at the end is of the whole run: of a longer one it is made anew.
TEST_F(Resuming, TheWordOfALongerRunIsWrittenOnce) {
  const Scene scene = parse_scene("law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\nrun.until = 50\n"
                                  "initial = { type = 'list', x = [0, 1, 2.3], v = [1, 0, -1.1] }\n"
                                  "walls = { left = { position = -1 }, right = { position = 4 } }\n"
                                  "output = { series.every = 10, word = 'any', events = true }\n",
                                  "scene.toml", {from_the_start});
  begin("a.h5", scene, {}, 1);
  ASSERT_EQ(resume("a.h5", "80", {}, 1).end, RunEnd::reached);
  expect_as_in_one_go("a.h5");
}

// A run whose result could not be written is finished before it is extended: its last sample belongs to its end.
TEST_F(Resuming, WhatIsNotWrittenYetIsWrittenFirst) {
  const Scene scene = parse_scene(dry(rows, ""), "scene.toml", {from_the_start});
  {
    RunFiles files(file("a.h5"), scene);
    Interrupt interrupt;
    Unwritten sink(files, interrupt, {});
    run_scene(scene, {Progress::Show::never, nullptr, &interrupt}, sink);  // and then the machine stops
  }
  EXPECT_THROW(RunFiles(file("a.h5"), "200"), Error);
  EXPECT_EQ(resume("a.h5", std::nullopt, {}, 1).end, RunEnd::reached);
  EXPECT_EQ(resume("a.h5", "120", {}, 1).end, RunEnd::reached);
}

}  // namespace resume_test
