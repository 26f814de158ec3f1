// Proofs of whole runs by the program, and the bounds in their files. (Every law that can be proved, threads, and where
// proofs end: tests/tools/outputs.txt. What is refused: tests/tools/messages.txt.)
#include <cmath>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::certify_program_test {

using namespace cradle::tools;

class Certified : public ProgramTest {
 protected:
  Result result() const { return read("a.h5"); }
  template <class T> T of_certificate(const char* name) const {
    const Result r = result();
    const Group* group = r.find("certificate");
    return group == nullptr ? T() : attribute<T>(group->attributes, name, "certificate");
  }
  Printed certify(const std::string& what, int status = 0) const {
    return shell("cradle certify " + what + " --force -o a.h5", status);
  }
  // The bounds of the last sample are near the run's own number, and there with more digits than a double has.
  static void expect_bounds(const Result& r, const std::string& name, double tolerance) {
    const double low = numbers(r, "series", name + "_low").back();
    EXPECT_NEAR(low, numbers(r, "series", name).back(), tolerance) << name;
    EXPECT_LE(low, numbers(r, "series", name + "_high").back()) << name;
    EXPECT_GT(numbers<std::string>(r, "exact/series", name + "_low").back().size(), 20U) << name;
  }
  Printed certify_scene(const std::string& text, int status = 0) const {
    write("scene.toml", text);
    return certify("scene.toml", status);
  }
};

TEST_F(Certified, AShockIsProvedWithBoundsOfItsResults) {
  const Printed printed =
      certify("fig2 --set initial.particles=120 --set law.restitution=0.97 --set run.until=100 --set "
              "output.snapshots=[50,100] --set output.profiles.times=[] --set output.series.points=5");
  EXPECT_TRUE(has(printed.out, "proved: "));
  const Result r = result();
  EXPECT_EQ(of_certificate<std::string>("verdict"), "proved");
  EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), numbers<std::uint64_t>(r, "series", "collisions").back());
  EXPECT_EQ(of_certificate<std::uint64_t>("digits"), 31U);
  const auto energy = numbers(r, "series", "energy"), low = numbers(r, "series", "energy_low"),
             high = numbers(r, "series", "energy_high");
  const auto text = numbers<std::string>(r, "exact/series", "energy_low");
  ASSERT_EQ(low.size(), 5U);
  for (std::size_t k = 0; k < low.size(); ++k) {
    EXPECT_LE(low[k], high[k]);
    EXPECT_LE(high[k] - low[k], 3e-16 * energy[k]);
    EXPECT_NEAR(energy[k], low[k], 1e-12 * energy[k]) << "the run's own energy";
    EXPECT_GT(text[k].size(), 26U) << text[k];
    EXPECT_NEAR(std::stod(text[k]), low[k], 3e-16 * energy[k]);
  }
  // Every particle of the snapshot is where the run has it.
  const auto x = numbers(r, "snapshots/0001", "x"), from = numbers(r, "certificate/snapshots/0001", "x_low"),
             to = numbers(r, "certificate/snapshots/0001", "x_high");
  ASSERT_EQ(x.size(), from.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_NEAR(x[k], from[k], 1e-11);
    EXPECT_LE(to[k] - from[k], 1e-12);
  }
}

// The collapse itself is an estimate beside the proof.
TEST_F(Certified, ACollapseIsProvedToTheEndOfTheRangeOfDoubles) {
#ifndef CRADLE_WITH_MPFR
  certify("collapse3", 5);
#else
  const Printed printed = certify("collapse3 --set 'output.snapshots=[1.7]'");
  const Result r = result();
  EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), 322U);
  EXPECT_LT(numbers(r, "certificate", "gap").back(), -290);
  // The ledger of a double ends at 1e-16 of what there was; the proof does not.
  EXPECT_LT(numbers(r, "series", "energy_high").back(), 1e-250);
  EXPECT_TRUE(begins(printed.out, "proved: 322 collisions"));
  EXPECT_TRUE(has(printed.out, "not proved: that this is an inelastic collapse"));
  EXPECT_TRUE(has(printed.out, "no bounds for snapshots/0001, initial, collapse: ")) << "the one at the end";
  EXPECT_TRUE(has(printed.out, "estimated by the run:\ninelastic collapse at"));
  EXPECT_NE(of_certificate<std::string>("not_proved"), "");
  EXPECT_EQ(of_certificate<std::string>("of_run_alone"), "snapshots/0001, initial, collapse");
#endif
}

TEST_F(Certified, ClustersHaveTheNamesOfTheRun) {
  certify_scene("law.type = \"sticky\"\ninitial = {type = \"list\", x = [0, 1, 2.5], v = [1, 0, 0], m = [1, 3, 1]}\n"
                "run.until = 1.25\noutput.snapshots = [1.25]\n");
  const Result r = result();
  const auto names = numbers<std::uint64_t>(r, "snapshots/0000", "index");
  EXPECT_EQ(names, (std::vector<std::uint64_t>{1, 2}));
  for (const char* proved : {"certificate/snapshots/0000", "exact/snapshots/0000"})
    EXPECT_EQ(numbers<std::uint64_t>(r, proved, "index"), names) << proved;
}

TEST_F(Certified, AccountsOfWallsHaveBounds) {
  const Printed printed =
      certify_scene("law = {type = \"inelastic\", restitution = 0.9, cutoff = 0.1, cutoff_exponent = 4}\n"
                    "initial = {type = \"list\", x = [1, 2, 3], v = [1, -1, 0.5]}\nrun.until = 10\n"
                    "walls.left = {position = 0, temperature = 1}\n"
                    "walls.right = {position = 4, speed = 0.01, restitution = 0.8}\n");
  EXPECT_TRUE(has(printed.out, "walls     left: "));
  EXPECT_FALSE(has(printed.out, "there are no more collisions"));
  const Result r = result();
  for (const char* name : {"wall_left_energy", "wall_right_energy", "wall_right_lost"}) {
    EXPECT_NE(numbers(r, "series", name).back(), 0) << name;
    expect_bounds(r, name, 1e-12);
  }
}

// A ball on an inelastic floor, until it is slower than the cut-off and after; a column over a thermal floor.
TEST_F(Certified, FallingParticlesAreProved) {
  certify_scene("law = {type = \"inelastic\", restitution = 0.9, cutoff = 0.1}\nrun.until = 10\n"
                "initial = {type = \"list\", x = [1], v = [1]}\noutput.snapshots = [5, 10]\n"
                "walls.left = {position = 0, restitution = 0.5}\ngravity.acceleration = -1\n");
  Result r = result();
  EXPECT_EQ(of_certificate<std::string>("verdict"), "proved");
  EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), numbers<std::uint64_t>(r, "series", "collisions").back());
  EXPECT_GT(of_certificate<std::uint64_t>("collisions"), 10U);
  EXPECT_EQ(of_certificate<std::uint64_t>("over"), 0U);
  for (const char* name : {"energy", "wall_left_lost"}) expect_bounds(r, name, 1e-13);
  EXPECT_NEAR(numbers(r, "certificate/snapshots/0001", "x_low")[0], numbers(r, "snapshots/0001", "x")[0], 1e-13);
  EXPECT_NEAR(numbers(r, "certificate/snapshots/0001", "v_high")[0], numbers(r, "snapshots/0001", "v")[0], 1e-13);
  certify("scene.toml --set initial.x=[1,2,3,4,5] --set initial.v=[1,-1,0.5,0,0.3] --set walls.left.restitution= --set "
          "walls.left.temperature=1 --set run.until=20");
  EXPECT_GT(of_certificate<std::uint64_t>("collisions"), 50U);
}

// After 8e15 turns a place has no digits in double, and the run's particles are anywhere; a proof knows their gaps.
TEST_F(Certified, GapsOnARingAreTheWayRoundWhereverTheRunHasItsParticles) {
  certify_scene(
      "law = {type = \"inelastic\", restitution = 0.68845428}\n"
      "initial = {type = \"list\", x = [0], gap = [6.1998253e-24, 2e-25], length = 1.9690000000000000000000063998253, "
      "v = [-1000000.490132653717308138479501174693, -1000000.497795655363910974387868526078, "
      "-1000000.919075993546211256539722001038]}\nrun.until = 37070000000\noutput.snapshots = [15940100000]\n");
  const Result r = result();
  double sum = 0;
  for (const double gap : numbers(r, "certificate/snapshots/0000", "gap_low")) {
    EXPECT_GE(gap, 0);
    sum += gap;
  }
  EXPECT_NEAR(sum, 1.969, 1e-6);
}
// A double does not count 2e17 turns.
TEST_F(Certified, PlacesOnARingAreFoldedAfterAnyNumberOfTurns) {
  certify_scene(
      "law = {type = \"inelastic\", restitution = 0.3}\ninitial = {type = \"list\", x = [0, 1, 5], length = 8.5, v = "
      "[12345.6773, 12345.6779, 12345.6781]}\nrun = {until = 1.455e14, precision = \"double-double\"}\n"
      "output.snapshots = [1.455e14]\n");
  for (const double x : numbers(result(), "snapshots/0000", "x")) {
    EXPECT_GE(x, 0);
    EXPECT_LT(x, 8.5);
  }
}

// A collision just at the time of a snapshot leaves that one open; those after it keep their numbers.
TEST_F(Certified, SnapshotsHaveTheNumbersOfTheRuns) {
  certify_scene("law = {type = \"inelastic\", restitution = 0.5}\ninitial = {type = \"list\", x = [0, 1], v = [1, 0]}\n"
                "run.until = 3\noutput.snapshots = [1, 2]\n");
  const Result r = result();
  EXPECT_EQ(r.find("certificate/snapshots/0000"), nullptr);
  EXPECT_NEAR(numbers(r, "certificate/snapshots/0001", "x_low")[1], numbers(r, "snapshots/0001", "x")[1], 1e-15);
}

// Runs end at their own collapses: each replica counts at the times that it has reached, as in an ensemble.
TEST_F(Certified, ReplicasHaveTheStatisticsOfTheirEnsemble) {
  const std::string scene = "collapse_times --set law.restitution=0.6 --set initial.particles=40 "
                            "--set run.until=30 --set output.series.points=31 --replicas 4";
  const Printed printed = certify(scene);
  EXPECT_TRUE(has(printed.out, "proved: 4 of 4 replicas"));
  EXPECT_FALSE(has(printed.out, "nan"));
  shell("cradle ensemble " + scene + " -o ensemble.h5 --quiet", 0);
  const Result proved = result(), ensemble = read("ensemble.h5");
  const char* const energy = "ensemble/series/energy";
  EXPECT_EQ(numbers<std::uint64_t>(proved, energy, "count"), numbers<std::uint64_t>(ensemble, energy, "count"));
  const auto mean = numbers(proved, energy, "mean"), expected = numbers(ensemble, energy, "mean");
  const auto sem = numbers(proved, energy, "sem"), expected_sem = numbers(ensemble, energy, "sem");
  ASSERT_EQ(mean.size(), expected.size());
  std::size_t reached = 0;
  for (std::size_t k = 0; k < mean.size(); ++k) {
    if (std::isnan(expected[k])) {
      EXPECT_TRUE(std::isnan(mean[k]));
      continue;
    }
    ++reached;
    EXPECT_NEAR(mean[k], expected[k], 1e-12);
    if (!std::isnan(expected_sem[k])) {
      EXPECT_NEAR(sem[k], expected_sem[k], 1e-12);
    }
  }
  EXPECT_GT(reached, 5U);
  EXPECT_LT(reached, mean.size());
}

}  // namespace cradle::tests::certify_program_test
