// Proofs of whole runs by the program: every law that it can prove, its messages where it cannot, and the files.
#include <cmath>
#include <string>
#include <vector>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::certify_program_test {

using namespace cradle::tools;

class Certified : public ProgramTest {
 protected:
  Result result() const { return read("a.h5"); }
  template <class T> T of_certificate(const char* name, const std::string& file = "a.h5") const {
    const Result r = read(file);
    const Group* group = r.find("certificate");
    return group == nullptr ? T() : attribute<T>(group->attributes, name, "certificate");
  }
  Printed certify(const std::string& what, int status = 0, const std::string& name = "a.h5") const {
    return shell("cradle certify " + what + " --force -o " + name, status);
  }
  // The bounds of the last sample are near the run's own number, and there with more digits than a double has.
  static void expect_bounds(const Result& r, const std::string& name, double tolerance) {
    const double low = numbers(r, "series", name + "_low").back();
    EXPECT_NEAR(low, numbers(r, "series", name).back(), tolerance) << name;
    EXPECT_LE(low, numbers(r, "series", name + "_high").back()) << name;
    EXPECT_GT(numbers<std::string>(r, "exact/series", name + "_low").back().size(), 20U) << name;
  }
  Printed certify_scene(const std::string& text, const std::string& more = "", int status = 0) const {
    write("scene.toml", text);
    return certify("scene.toml" + more, status);
  }
  Printed certify_list(const std::string& law, const std::string& x, const std::string& v, const std::string& until,
                       int status = 0) const {
    return certify_scene("law = {" + law + "}\ninitial = {type = \"list\", x = [" + x + "], v = [" + v +
                             "]}\nrun.until = " + until,
                         "", status);
  }
};

#ifdef CRADLE_WITH_MPFR
constexpr int proved_in_wide_types = 0;
#else
constexpr int proved_in_wide_types = 5;
#endif
const std::string small_shock = "fig2 --set initial.particles=120 --set law.restitution=0.97 --set run.until=100 --set "
                                "output.snapshots=[50,100] --set output.profiles.times=[] --set output.series.points=5";

TEST_F(Certified, AShockIsProvedWithBoundsOfItsResults) {
  const Printed printed = certify(small_shock);
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

TEST_F(Certified, TwiceTheSameBytesThatAreReadExportedAndDrawn) {
  certify(small_shock);
  certify(small_shock, 0, "b.h5");
  shell("cmp a.h5 b.h5", 0);
  shell("cradle diff a.h5 b.h5", 0);
  certify(small_shock + " --set initial.seed=2", 0, "b.h5");
  EXPECT_TRUE(has(shell("cradle diff a.h5 b.h5 --all").out, "exact/series/energy_low: first in row"));
  shell("cradle export a.h5 --to csv", 0);
  EXPECT_TRUE(has(contents(folder / "csv/exact/series.csv"), "e+0"));
  const Printed printed = shell("cradle info a.h5", 0);
  EXPECT_TRUE(has(printed.out, "verdict = proved"));
}

TEST_F(Certified, ThreadsChangeNothing) {
  const std::pair<std::string, int> scenes[] = {
      {"fig2 --set initial.particles=500 --set law.restitution=0.99 --set run.until=300 --set output.snapshots=[100] "
       "--set output.profiles.times=[] --set output.series.points=5",
       0},
      {"collapse3 --digits 31", 5}};
  for (const auto& [scene, status] : scenes) {
    const auto verdict = [](const Printed& printed) { return printed.out.substr(0, printed.out.find('\n')); };
    const std::string one = verdict(certify(scene + " --threads 1", status));
    for (const char* more : {" --threads 2", " --threads 3"}) {
      EXPECT_EQ(verdict(certify(scene + more, status, "b.h5")), one);
      shell("cmp a.h5 b.h5", 0);
    }
  }
  certify(scenes[0].first);
  EXPECT_GT(of_certificate<std::uint64_t>("collisions"), 20000U) << "several pieces";
}

// The collapse itself is an estimate beside the proof.
TEST_F(Certified, ACollapseIsProvedToTheEndOfTheRangeOfDoubles) {
  const Printed printed = certify("collapse3", proved_in_wide_types);
#ifdef CRADLE_WITH_MPFR
  const Result r = result();
  EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), 322U);
  EXPECT_LT(numbers(r, "certificate", "gap").back(), -290);
  // The ledger of a double ends at 1e-16 of what there was; the proof does not.
  EXPECT_LT(numbers(r, "series", "energy_high").back(), 1e-250);
  EXPECT_TRUE(begins(printed.out, "proved: 322 collisions"));
  EXPECT_TRUE(has(printed.out, "not proved: that this is an inelastic collapse"));
  EXPECT_TRUE(has(printed.out, "estimated by the run:\ninelastic collapse at"));
  EXPECT_NE(of_certificate<std::string>("not_proved"), "");
#endif
  const Printed with_31 = certify("collapse3 --digits 31", 5, "b.h5");
  EXPECT_TRUE(has(with_31.out, "undecided at t = 1.71428571428571"));
  EXPECT_EQ(of_certificate<std::string>("verdict", "b.h5"), "undecided");
}

TEST_F(Certified, EveryLawThatCanBe) {
  const std::string few = " --set output.series.points=3 --set output.snapshots=[] --set output.profiles.times=[] ";
  const auto list = [&](const char* file) { return std::string("list.toml --set initial.file=") + file + few; };
  write("equal.csv", "x,v\n0,1.1\n1.3,0.2\n3.1,-0.7\n4,-1\n");
  write("unequal.csv", "x,v,m\n0,1.1,1\n1.3,0.2,2.5\n3.1,-0.7,0.3\n4,-1,1\n");
  write("list.toml", "law = {type = \"inelastic\", restitution = 0.9, cutoff = 0.01}\n"
                     "initial = {type = \"list\", file = \"equal.csv\"}\nrun.until = 30\n");
  std::vector<std::string> scenes{
      list("equal.csv"),
      list("equal.csv") + "--set law.restitution=1",
      list("equal.csv") + "--set run.collapse=contact-time --set run.contact_time=0.3 --set law.cutoff=0",
      list("equal.csv") + "--set run.collapse=merge --set run.merge_speed=0.05 --set law.cutoff=0",
      list("unequal.csv"),
      "cooling --set initial.particles=40 --set run.until=10 --set output.masses=[]" + few,
      "cooling --set law.type=sticky --set law.restitution= --set law.cutoff= --set initial.particles=40 --set "
      "run.until=10 --set output.masses=[]" +
          few,
      "fig1 --set initial.left.particles=30 --set initial.right.particles=30 --set run.until=40 --set "
      "output.profiles.range=[-50,50] --set initial.perturbation=0.1" +
          few,
      "fig6 --set initial.particles=60 --set law.loss=0.01 --set run.until=30 --set initial.perturbation=0.1" + few};
  for (const std::string& scene : scenes) certify(scene);
}

// G. Galperin, Regul. Chaotic Dyn. 8, 375 (2003): the digits of pi, and no more collisions after them.
TEST_F(Certified, TheDigitsOfPiAreProved) {
  std::uint64_t collisions[] = {3, 31, 314, 3141, 31415, 314159};
  for (const std::uint64_t count : collisions) {
    const std::string zeros(2 * (std::to_string(count).size() - 1), '0');
    const Printed printed =
        certify("classics/galperin --set output.series.points=3 --set initial.m=[1,1" + zeros + "]");
    EXPECT_TRUE(begins(printed.out, "proved: " + std::to_string(count) + " collisions up to t = 100 "));
    EXPECT_TRUE(has(printed.out, "no particles approach each other: there are no more collisions"));
    EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), count);
    EXPECT_EQ(of_certificate<std::uint64_t>("over"), 1U);
    EXPECT_EQ(of_certificate<std::uint64_t>("digits"), 31U);
  }
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

// Nothing of it is proved, but precisions can be compared.
TEST_F(Certified, ShakenWallsAndRestAreRefusedByName) {
  write("list.toml", "law = {type = \"inelastic\", restitution = 0.9, cutoff = 0.1}\nrun.until = 10\n"
                     "initial = {type = \"list\", x = [1], v = [1]}\n"
                     "walls.left.position = 0\ngravity.acceleration = -1\n");
  EXPECT_TRUE(has(certify("list.toml --set walls.left.rest_speed=0.1", 2).err,
                  "walls.left.rest_speed: rest on a wall is not provable (found 0.1): "));
  EXPECT_TRUE(has(certify("list.toml --set walls.left.motion=sine --set walls.left.amplitude=0.1 --set "
                          "walls.left.frequency=3",
                          2)
                      .err,
                  "walls.left.motion: shaken walls are not provable"));
  const Printed trusted = shell("cradle trust list.toml --digits 16,31 -o trust.h5", 0);
  EXPECT_TRUE(has(trusted.out, "to the end\n"));
}

TEST_F(Certified, ThreeThatMeetAtOneTimeAreUndecidedAndNamed) {
  const Printed printed =
      certify_list("type = \"inelastic\", restitution = 0.9, cutoff = 0.01", "-1, 0, 1", "1, 0, -1", "30", 5);
  EXPECT_TRUE(has(printed.out,
                  "undecided at t = 1, after 1 collisions, particles 1 and 2: open whether they meet after the last "
                  "collision of either"));
  EXPECT_EQ(of_certificate<std::uint64_t>("collisions"), 1U);
  EXPECT_EQ(shell("cradle resume a.h5").status, 5) << "as it ended";
  EXPECT_TRUE(has(certify("fig10", 2).err, "no collisions to prove"));
  certify("fig2 --digits 5", 2);
}

// Each of several separate regions has ends; the fronts are the outermost of all.
TEST_F(Certified, FrontsOfSeparateRegionsAreTheOutermost) {
  certify_list("type = \"inelastic\", restitution = 0.5", "0, 1, 10, 11, 20, 21", "1, 0, 0, 0, 1, 0", "3.5");
  const Result r = result();
  EXPECT_NEAR(numbers(r, "series", "front_left_low").back(), 1.625, 1e-15);
  EXPECT_NEAR(numbers(r, "series", "front_right_high").back(), 22.875, 1e-14);
  EXPECT_EQ(numbers(r, "series", "front_left").back(), 1.625) << "the run's own";
}

// The end of the scene is a decimal that a double does not hold, and so may be those of its samples.
TEST_F(Certified, TheEndIsThatOfTheSceneWithAllItsDigits) {
  const Printed printed = certify_list("type = \"sticky\"", "0, \"3.00000000000000024\"", "3, 0",
                                       "\"1.00000000000000011\"\noutput.series.every = 0.3");
  EXPECT_TRUE(has(printed.out, "proved: 1 collisions up to t = 1.00000000000000011 "));
  EXPECT_EQ(of_certificate<std::string>("proved_until"), "1.00000000000000011");
  EXPECT_EQ(numbers<std::string>(result(), "exact/series", "time"),
            (std::vector<std::string>{"0", "0.3", "0.6", "0.9"}));
}

// The time at which a run in double has made a collision of a collapse is not when the exact system makes it: here it
// is off in the tenth digit (in 220 digits the twelfth collision is at 9.4791802662302e-18).
TEST_F(Certified, ACollapseIsProvedUntilTheExactTimeOfItsLastCollision) {
  const Printed printed = certify_list(
      "type = \"inelastic\", restitution = 2.43e-02",
      "0.649354, 0.6493540000014112574, \"0.649354000001411257400007523388161819791\", "
      "\"0.649354000001411257400007523531245709791\", \"0.669354000001411257400007523531245709791\", "
      "\"0.6693540000014112574000075244424153992052319\", \"0.6693540000014112634000075244424153992052319\", "
      "\"0.6693540000014112635170967085063276992052319\"], m = [2.2202e+02, 3e+01, 1e-01, 6.2177e+00, 5.0853e-01, "
      "5.7013e-02, 1e-03, 2.3e-01",
      "\"-999999.2793722995710334372027\", \"-1000000.4901902934209605381171\", \"-999999.1238110696242868336671\", "
      "\"-999999.2709463878423401892167\", \"-999999.3312042298491810080550\", \"-999999.0904222501232596794812\", "
      "\"-999999.6388902679735954006348\", \"-999999.7361544802161529412000\"",
      "1.299e-17");
  EXPECT_TRUE(has(printed.out, "proved: 12 collisions up to t = 9.47918026623018"));
  EXPECT_TRUE(of_certificate<std::string>("proved_until").starts_with("9.47918026623018"));
}
// The proof in double-double knows the first collision to 1e-32, which is 1e-4 of its time; the run knows it better.
TEST_F(Certified, TheRunsNumberStaysWhereTheProofEnclosesIt) {
  certify_list("type = \"inelastic\", restitution = 1",
               "0.478246, 0.4782460000219, \"0.4782460000219001942913860766875\", "
               "\"0.4782460000219001942914919863775\", \"0.4782460000219001942914919863975\"",
               "0.937093867552, 0.868580934935, -0.143444253136, -0.259643840894, -0.563198376465",
               "3.516e-9\noutput.events = true");
  EXPECT_EQ(numbers(result(), "events", "time").front(), 2e-29 / 0.303554535571);
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
#ifdef CRADLE_WITH_MPFR
  EXPECT_TRUE(begins(
      certify_scene("law = {type = \"inelastic\", restitution = 1}\ninitial = {type = \"list\", x = [0.3, 2.5, 4], v = "
                    "[1.1, 1.1, 1.1], length = 5.5}\noutput.snapshots = [1e49]\n"
                    "run = {until = 1e49, precision = \"mpfr\", digits = 100}\n")
          .out,
      "proved"))
      << "2e48 turns, of which a double counts the first digits";
#endif
}

TEST_F(Certified, AMassTooSmallForADoubleIsThere) {
  certify_scene("law = {type = \"inelastic\", restitution = 0.9, cutoff = 0.01}\nrun.until = 0.47\n"
                "initial = {type = \"rows\", left = {particles = 3, speed = 1, density = 1}, right = "
                "{particles = 3, speed = -1, density = 1}, centre = {mass = 1e-400, speed = 0.1}}\n",
                "", 2);  // a double does not hold it
#ifdef CRADLE_WITH_MPFR
  const Printed printed = certify("scene.toml --set run.precision=mpfr --set run.digits=50");
  EXPECT_TRUE(begins(printed.out, "proved: 1 collisions")) << "without it there is none";
#endif
}

// Equal masses are recognised by their decimals: whether the mean velocity of a ring is a whole number depends on it.
TEST_F(Certified, RingsOfOneMassThatIsNoWholeNumber) {
  certify("cooling --set initial.particles=40 --set initial.masses=[0.1] --set run.until=5 --set output.masses=[] "
          "--set output.snapshots=[] --set output.profiles.times=[]");
}

// A collision just at the time of a snapshot leaves that one open; those after it keep their numbers.
TEST_F(Certified, SnapshotsHaveTheNumbersOfTheRuns) {
  certify_list("type = \"inelastic\", restitution = 0.5", "0, 1", "1, 0", "3\noutput.snapshots = [1, 2]");
  const Result r = result();
  EXPECT_EQ(r.find("certificate/snapshots/0000"), nullptr);
  ASSERT_NE(r.find("certificate/snapshots/0001"), nullptr);
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
