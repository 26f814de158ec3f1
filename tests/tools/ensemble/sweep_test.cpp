// Sweeps: the points that texts describe, and the table of a small sweep compared with runs made one by one. (Texts
// that are refused: tests/tools/messages.txt.)
#include "cradle/tools/ensemble/study.hpp"

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::sweep_test {

using namespace cradle::tools;

Sweep of(std::vector<std::string> vary, bool cuts = false, std::vector<std::string> points = {}) {
  Sweep sweep;
  sweep.vary = std::move(vary);
  sweep.cuts = cuts;
  sweep.points = std::move(points);
  return sweep;
}

TEST(SweepPoints, AreEvenAndKeepTheEndsAsWritten) {
  const auto points = sweep_points(of({"law.loss=0.1:0.5:5"}));
  ASSERT_EQ(points.size(), 5U);
  for (const char* value : {"0.1", "0.2", "0.3", "0.4", "0.5"})
    EXPECT_EQ(points[static_cast<std::size_t>(value[2] - '1')], SweepPoint{std::string("law.loss=") + value});
  const auto decades = sweep_points(of({"law.loss=1e-3:1e1:5:log"}));
  ASSERT_EQ(decades.size(), 5U);
  EXPECT_EQ(decades.front()[0], "law.loss=1e-3");
  EXPECT_EQ(decades[1][0], "law.loss=0.01");
  EXPECT_EQ(decades[2][0], "law.loss=0.1");
  EXPECT_EQ(decades.back()[0], "law.loss=1e1");
}

TEST(SweepPoints, CombineOrCutOrStandOneByOne) {
  const std::vector<std::string> two{"law.loss=0.1,0.2", "initial.speed=1:3:3"};
  const auto grid = sweep_points(of(two));
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_EQ(grid[1], (SweepPoint{"law.loss=0.1", "initial.speed=2"}));
  EXPECT_EQ(grid[3], (SweepPoint{"law.loss=0.2", "initial.speed=1"}));
  const auto cuts = sweep_points(of(two, true));
  ASSERT_EQ(cuts.size(), 5U);
  EXPECT_EQ(cuts[4], SweepPoint{"initial.speed=3"});
  const auto given = sweep_points(of({}, false, {"law.type=wet law.loss=0.3", "law.type=sticky"}));
  ASSERT_EQ(given.size(), 2U);
  EXPECT_EQ(given[0], (SweepPoint{"law.type=wet", "law.loss=0.3"}));
}

// Found by fuzzing: with a million for a thousand, many keys of so many values each were written out before they were
// counted.
TEST(SweepPoints, AreCountedBeforeMemoryForThemIsTaken) {
  const auto refused = [](const Sweep& sweep) { return refusal(Exit::bad_input, [&] { sweep_points(sweep, 1000); }); };
  const std::vector<std::string> nine(9, "law.loss=1:2:1000");  // of which the first two are too many
  EXPECT_TRUE(has(refused(of(nine)), "too many points (found 1e+06)"));
  EXPECT_TRUE(has(refused(of(nine, true)), "too many points (found 2e+03)"));
  std::vector<std::string> of_one_value(8, "law.type=wet");  // in each of the points
  of_one_value.emplace_back("law.loss=1:2:1000");
  EXPECT_TRUE(has(refused(of(of_one_value)), "too many values (found 9e+03 in all points)"));
  EXPECT_EQ(sweep_points(of({"law.loss=1:2:3", "initial.seed=1:3:3"}), 9).size(), 9U);
  EXPECT_THROW(sweep_points(of({"law.loss=1:2:3", "initial.seed=1:3:3"}), 8), Error);
}

class SweepCommand : public ProgramTest {};

TEST_F(SweepCommand, TableIsTheMeanOfTheRuns) {
  const std::string scene = "fig7 --set initial.particles=200 --set run.until=60 --set output.zone.from=20 "
                            "--set output.series.points=3 ";
  const std::string command = "cradle sweep " + scene + "--vary law.loss=0.01,0.02 --replicas 3 --quiet -o sweep.h5";
  shell(command, 0);
  const Result result = read("sweep.h5");
  EXPECT_EQ(numbers(result, "sweep", "law.loss"), (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(numbers(result, "sweep", "replicas"), (std::vector<double>{3, 3}));
  double sum = 0, squares = 0;
  for (const int replica : {0, 1, 2}) {
    const std::string number = std::to_string(replica);
    shell("cradle run " + scene + "--set law.loss=0.02 --set initial.replica=" + number + " --quiet --force -o one.h5",
          0);
    const double energy = numbers(read("one.h5"), "series", "energy").back();
    sum += energy, squares += energy * energy;
  }
  // Rounding of sums of energies of order 25.
  EXPECT_NEAR(numbers(result, "sweep", "energy")[1], sum / 3, 1e-13);
  EXPECT_NEAR(numbers(result, "sweep", "energy_error")[1], std::sqrt((squares - sum * sum / 3) / 6), 1e-6);
  // The points are ensembles; the same command finds nothing left to do, another sweep is refused.
  EXPECT_NE(result.find("points/0001/replicas"), nullptr);
  const auto before = contents(path("sweep.h5"));
  shell(command, 0);
  EXPECT_EQ(contents(path("sweep.h5")), before);
  shell("cradle sweep " + scene + "--vary law.loss=0.01,0.03 --replicas 3 --quiet -o sweep.h5", 2);
  shell("cradle sweep " + scene + "--vary law.los=0.01,0.03 --quiet -o other.h5", 2);
}

}  // namespace cradle::tests::sweep_test
