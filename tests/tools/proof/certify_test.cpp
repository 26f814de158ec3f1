// Proofs of whole runs by the program: at a collapse, after very many turns of a ring, of replicas. (Bounds in files:
// references_test.cpp and agreement_test.cpp. Every law that can be proved, threads, and where proofs end:
// tests/tools/outputs.txt. What is refused: tests/tools/messages.txt.)
#include <cmath>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::certify_program_test {

using namespace cradle::tools;

class Certified : public ProgramTest {
 protected:
  // Returns what it prints.
  Printed certify(const std::string& what, int status = 0) const {
    return shell("cradle certify " + what + " --force -o a.h5", status);
  }
  Result certified(const std::string& scene) const {
    write("scene.toml", scene);
    certify("scene.toml");
    return read("a.h5");
  }
};

// The collapse itself is an estimate beside the proof.
TEST_F(Certified, ACollapseIsProvedToTheEndOfTheRangeOfDoubles) {
#ifndef CRADLE_WITH_MPFR
  certify("collapse3", 5);
#else
  const Printed printed = certify("collapse3 --set 'output.snapshots=[1.7]'");
  const Result r = read("a.h5");
  const auto& found = r.find("certificate")->attributes;
  EXPECT_EQ(attribute<std::uint64_t>(found, "collisions", ""), 322U);
  EXPECT_LT(numbers(r, "certificate", "gap").back(), -290);
  // The ledger of a double ends at 1e-16 of what there was; the proof does not.
  EXPECT_LT(numbers(r, "series", "energy_high").back(), 1e-250);
  EXPECT_TRUE(begins(printed.out, "proved: 322 collisions"));
  EXPECT_TRUE(has(printed.out, "not proved: that this is an inelastic collapse"));
  EXPECT_TRUE(has(printed.out, "no bounds for snapshots/0001, initial, collapse: ")) << "the one at the end";
  EXPECT_TRUE(has(printed.out, "estimated by the run:\ninelastic collapse at"));
  EXPECT_NE(attribute<std::string>(found, "not_proved", ""), "");
  EXPECT_EQ(attribute<std::string>(found, "of_run_alone", ""), "snapshots/0001, initial, collapse");
#endif
}

TEST_F(Certified, ClustersHaveTheNamesOfTheRun) {
  const Result r =
      certified("law.type = \"sticky\"\ninitial = {type = \"list\", x = [0, 1, 2.5], v = [1, 0, 0], m = [1, 3, 1]}\n"
                "run.until = 1.25\noutput.snapshots = [1.25]\n");
  for (const char* name : {"snapshots/0000", "certificate/snapshots/0000", "exact/snapshots/0000"})
    EXPECT_EQ(numbers<std::uint64_t>(r, name, "index"), (std::vector<std::uint64_t>{1, 2})) << name;
}

// After 8e15 turns a place has no digits in double, and the run's particles are anywhere; a proof knows their gaps.
TEST_F(Certified, GapsOnARingAreTheWayRoundWhereverTheRunHasItsParticles) {
  const Result r = certified(
      "law = {type = \"inelastic\", restitution = 0.68845428}\n"
      "initial = {type = \"list\", x = [0], gap = [6.1998253e-24, 2e-25], length = 1.9690000000000000000000063998253, "
      "v = [-1000000.490132653717308138479501174693, -1000000.497795655363910974387868526078, "
      "-1000000.919075993546211256539722001038]}\nrun.until = 37070000000\noutput.snapshots = [15940100000]\n");
  double sum = 0;
  for (const double gap : numbers(r, "certificate/snapshots/0000", "gap_low")) {
    EXPECT_GE(gap, 0);
    sum += gap;
  }
  EXPECT_NEAR(sum, 1.969, 1e-6);
}
// A double does not count 2e17 turns.
TEST_F(Certified, PlacesOnARingAreFoldedAfterAnyNumberOfTurns) {
  const Result r = certified(
      "law = {type = \"inelastic\", restitution = 0.3}\ninitial = {type = \"list\", x = [0, 1, 5], length = 8.5, v = "
      "[12345.6773, 12345.6779, 12345.6781]}\nrun = {until = 1.455e14, precision = \"double-double\"}\n"
      "output.snapshots = [1.455e14]\n");
  for (const double x : numbers(r, "snapshots/0000", "x")) {
    EXPECT_GE(x, 0);
    EXPECT_LT(x, 8.5);
  }
}

// Runs end at their own collapses: each replica counts at the times that it has reached, as in an ensemble.
TEST_F(Certified, ReplicasHaveTheStatisticsOfTheirEnsemble) {
  const std::string scene = "collapse_times --set law.restitution=0.6 --set initial.particles=40 "
                            "--set run.until=30 --set output.series.points=31 --replicas 4";
  const Printed printed = certify(scene);
  EXPECT_TRUE(has(printed.out, "proved: 4 of 4 replicas"));
  EXPECT_FALSE(has(printed.out, "nan"));
  shell("cradle ensemble " + scene + " -o ensemble.h5 --quiet", 0);
  const Result proved = read("a.h5"), ensemble = read("ensemble.h5");
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
