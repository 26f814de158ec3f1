// Runs that are stopped anywhere and resumed end in the bytes of an uninterrupted run: law x scalar type x coordinates
// x initial state x policy x threads x where it is cut. (Later ends without a checkpoint: tests/tools/run/outputs.txt.)
#include <ostream>

#include "cradle/tests/tools/cases.hpp"
#include "cradle/tests/tools/store/stopping.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace resume_test {

using namespace cradle::tools;
using namespace cradle::tests;

// Keeps back how the run ended, so that its file is not written.
class Unwritten final : public RunFiles {
 public:
  using RunFiles::RunFiles;
  void end(std::vector<Attribute>&& attributes, RunEnd) override { attributes_ = std::move(attributes); }
  void write() { RunFiles::end(std::move(attributes_), RunEnd::reached); }

 private:
  std::vector<Attribute> attributes_;
};

struct CutRun {
  std::string name, scene;
  std::size_t threads = 1, threads_later = 1;
  std::vector<std::string> precisions = {"double", "long double", "double-double", "cpp_bin_float", "float128", "mpfr"};
};

std::ostream& operator<<(std::ostream& out, const CutRun& of) { return out << of.name; }

// Runs in six types, four cuts each with another one behind it.
std::vector<CutRun> cut_runs() {
  std::vector<CutRun> all;
  for (const ListedCase& listed : cases_in("store/resume_scenes.txt")) {
    std::istringstream head(listed.name());
    CutRun& one = all.emplace_back();
    head >> one.name;
    if (head >> one.threads >> one.threads_later)
      for (one.precisions.clear(); head >> std::ws && !head.eof();)
        std::getline(head, one.precisions.emplace_back(), ',');
    one.scene = listed.below_name();
  }
  return all;
}

class Resuming : public ProgramTest {
 protected:
  // Returns how it ended; FILE is there if it did. `from`: the scene of a new run; where a run is resumed, its end.
  RunOutcome run(const char* name, const auto& from, Stopping::At at, std::size_t threads) const {
    Interrupt interrupt;
    Stopping files(interrupt, at, path(name), from);
    cradle::Workers workers;  // one after the other, as many as required
    workers.count = threads;
    return run_scene(files.scene(), {Progress::Show::never, nullptr, &interrupt, workers}, files);
  }
  RunOutcome begin(const char* name, const Scene& scene, Stopping::At at, std::size_t threads) const {
    return run(name, scene, at, threads);
  }
  RunOutcome resume(const char* name, const std::optional<std::string>& until, Stopping::At at,
                    std::size_t threads) const {
    return run(name, until, at, threads);
  }
  // The bytes are those of the file's own scene, run from the beginning.
  void expect_as_in_one_go(const char* name) const {
    begin("alone.h5", scene_in(read_result(path(name)).attributes, path(name)), {}, 1);
    EXPECT_TRUE(contents(path("alone.h5")) == contents(path(name))) << "other bytes";
  }
};

class Resume : public Resuming, public testing::WithParamInterface<CutRun> {};

TEST_P(Resume, EndsInTheSameBytesWhereverItIsCut) {
  const CutRun& of = GetParam();
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
    const std::string wanted = contents(path("alone.h5"));
    ASSERT_GT(whole.collisions, 4U);
    for (const Stopping::At at : {Stopping::At{.collisions = 1},
                                  {.collisions = whole.collisions / 3},
                                  {.collisions = 4 * whole.collisions / 5},
                                  {.checks = 7}}) {
      SCOPED_TRACE(testing::Message() << "collisions " << at.collisions << ", looks " << at.checks);
      const RunOutcome cut = begin("cut.h5", scene, at, of.threads);
      if (cut.end == RunEnd::interrupted) {
        EXPECT_FALSE(exists("cut.h5"));
        const Stopping::At half{.collisions = cut.collisions + (whole.collisions - cut.collisions) / 2};
        if (resume("cut.h5", std::nullopt, half, of.threads_later).end == RunEnd::interrupted) {
          EXPECT_EQ(resume("cut.h5", std::nullopt, {}, of.threads_later).end, whole.end);
        }
      }
      EXPECT_TRUE(contents(path("cut.h5")) == wanted) << "other bytes";
      EXPECT_FALSE(exists("cut.h5.part"));
      std::filesystem::remove(path("cut.h5"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, Resume, testing::ValuesIn(cut_runs()), [](const auto& of) { return of.param.name; });

// ---- extended

// A checkpoint at every sample, on any machine.
constexpr const char* from_the_start = "output.checkpoint.every_seconds=1e-9";

Scene dry_rows(const std::string& setting = from_the_start) {
  return parse_scene(cut_runs().front().scene, "scene.toml", {setting});
}

TEST_F(Resuming, ALaterEndGivesTheBytesOfASceneThatHadItFromTheBeginning) {
  const std::string inelastic = "law = { type = 'inelastic', restitution = 0.9, cutoff = 1e-3 }\n",
                    sticky = "law.type = 'sticky'\n", wet = "law = { type = 'wet', loss = 0.01 }\n",
                    rows = "initial = { type = 'rows', particles = 80, perturbation = 0.05 }\n",
                    general = "initial = { type = 'rows', left = { particles = 40, speed = 1 }, right = { particles = "
                              "30, speed = -0.5, density = 2 }, centre = { mass = 5, speed = 0.1 }, perturbation = "
                              "0.1 }\n";
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

        EXPECT_EQ(scene_in(read_result(path("later.h5")).attributes, "later.h5").run.until, Decimal("60"));
        expect_as_in_one_go("later.h5");
        std::filesystem::remove(path("later.h5"));
      }
    }
  }
}

// An extension whose journal has no checkpoint yet begins again from the result and its checkpoint.
TEST_F(Resuming, AnExtensionStoppedBeforeItsFirstCheckpointBeginsAgain) {
  const Scene scene = dry_rows();
  begin("a.h5", scene, {}, 1);
  const std::string checkpoint = contents(path("a.h5.checkpoint"));
  ASSERT_EQ(resume("a.h5", "120", {.checks = 2}, 1).end, RunEnd::interrupted);
  { std::ofstream(path("a.h5.checkpoint"), std::ios::binary) << checkpoint; }  // as a kill before it was written
  EXPECT_NE(RunFiles(path("a.h5"), std::nullopt).resumed_from(), "");
  ASSERT_EQ(resume("a.h5", std::nullopt, {}, 1).end, RunEnd::reached);
  expect_as_in_one_go("a.h5");
}

// Whether there is a journal, and from when on, changes nothing in the result.
TEST_F(Resuming, ARunThatHasNothingToLoseWritesItsFileAlone) {
  for (const char* every : {"0", "1e-9"}) {
    const Scene scene = dry_rows(std::string("output.checkpoint.every_seconds=") + every);
    const std::string name = std::string("a") + every + ".h5";
    Unwritten files(path(name), scene);
    run_scene(scene, {Progress::Show::never}, files);
    EXPECT_EQ(exists(name + ".part"), files.up_to_date());
    if (*every == '1') {
      EXPECT_TRUE(files.up_to_date());
    }
    files.write();
    EXPECT_FALSE(exists(name + ".part"));
  }
  EXPECT_TRUE(contents(path("a0.h5")) == contents(path("a1e-9.h5"))) << "other bytes";
}

// A run whose result could not be written is finished before it is extended: its last sample belongs to its end.
TEST_F(Resuming, WhatIsNotWrittenYetIsWrittenFirst) {
  const Scene scene = dry_rows();
  {
    Unwritten files(path("a.h5"), scene);
    run_scene(scene, {Progress::Show::never}, files);  // and then the machine stops
  }
  EXPECT_THROW(RunFiles(path("a.h5"), "200"), Error);
  EXPECT_EQ(resume("a.h5", std::nullopt, {}, 1).end, RunEnd::reached);
  EXPECT_EQ(resume("a.h5", "120", {}, 1).end, RunEnd::reached);
}

}  // namespace resume_test
