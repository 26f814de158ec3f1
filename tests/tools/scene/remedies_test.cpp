// Messages that advise something: each is followed as a user would, and then the command succeeds. What the command
// line leaves out of a scene is said.

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::remedies_test {

class Remedies : public ProgramTest {};

// One number of a list, by `--set`, as a value that a sweep varies, and in its points.
TEST_F(Remedies, OneNumberOfAList) {
  const std::string scene = "collapse3 --set initial.m=[1,1,1] --set run.until=1 ";
  EXPECT_TRUE(has(shell("cradle check " + scene + "--set initial.m[1]=2.5").out, "[1, 2.5, 1]"));
  shell("cradle sweep " + scene + "--vary initial.m[1]=1:3:3 --point initial.m[0]=5 --quiet -o s.h5", 0);
  EXPECT_EQ(numbers(read("s.h5"), "sweep", "initial.m[1]")[2], 2);
  shell("cradle threshold " + scene + "--vary initial.m[1]=0.5:3 --no-proof --quiet -o t.h5");
}

TEST_F(Remedies, MergeIsQuiet) {
  const std::string one = "cradle ensemble fig2 --replicas 1 --set initial.particles=20 --set run.until=1 --set "
                          "initial.perturbation=0.1 --set output.snapshots= --set output.profiles.times= --quiet ";
  shell(one + "-o a.h5 && " + one + "--first 1 -o b.h5", 0);
  EXPECT_EQ(shell("cradle merge a.h5 b.h5 -o c.h5 --quiet", 0).out, "");
  EXPECT_TRUE(has(shell("cradle merge a.h5 b.h5 -o c.h5", 0).out, "wrote c.h5"));
}

// What a run says of what it could not resolve can be followed.
TEST_F(Remedies, OfWhatARunCannotResolve) {
  const std::string three =
      "cradle run collapse3 --set initial.x=[0,1,2] --set law.restitution=0.9 --set run.stop_gap= "
      "--set run.until=1 --force -o a.h5 ";
  EXPECT_TRUE(has(shell(three, 0).err, "in 3 collisions three particles met at one time, within rounding: then the "
                                       "numbers do not say which pair collides first, and the left one is taken; "
                                       "where that matters, give other initial.x or initial.v"));
  EXPECT_EQ(shell(three + "--set initial.x=[0,1,2.1] --set run.until=1.01", 0).err, "");
  // A cut-off that is too low for the run is to be raised.
  write("low.toml", "law = { type = 'inelastic', restitution = 0.05, cutoff = 1e-300 }\nrun.until = 2\n"
                    "initial = { type = 'list', x = [0, 1, 3], v = [1, 0, -1] }\n");
  const Printed low = shell("cradle run low.toml --force -o a.h5", 5);
  EXPECT_TRUE(has(low.err, "use a higher law.cutoff, or none, with which a run ends at a collapse, or more digits"))
      << low.err;
  shell("cradle run low.toml --force -o a.h5 --set law.cutoff=1e-100", 0);
  shell("cradle run low.toml --force -o a.h5 --set law.cutoff=", 3);
}

TEST_F(Remedies, SayWhichTimesAShorterRunLeavesOut) {
  const std::string run = "cradle run fig2 --set initial.particles=40 --set output.profiles.times= -o a.h5 ";
  const std::string left_out = "times of the scene outside the run are left out: output.snapshots (";
  EXPECT_EQ(shell(run + "--set run.until=1200", 0).err, left_out + "1500, 2000, 3000, 4000, 5000, 6500)\n");
  EXPECT_EQ(shell(run + "--set run.until=1200 --quiet", 0).err, "");
  EXPECT_EQ(shell(run + "--set run.until=3 --force", 0).err, left_out + "8 times, 500 to 6500)\n");
  EXPECT_EQ(shell("cradle ensemble fig2 --replicas 1 --set initial.particles=40 --set run.until=3 --set "
                  "output.profiles.times=",
                  0)
                .err,
            left_out + "8 times, 500 to 6500)\n");
  // They do not come back, and the reason is said.
  const Printed longer = shell("cradle resume a.h5 --until 600", 0);
  EXPECT_EQ(longer.err,
            "lists of times are not extended beyond t = 3 (output.snapshots, output.profiles.times): to have "
            "later times of the scene, run it with --set run.until=600\n");
  EXPECT_EQ(read("a.h5").find("snapshots/0000"), nullptr);
  EXPECT_EQ(shell("cradle resume a.h5 --until 700", 0).err, "");  // there are none between 600 and 700
  shell(run + "--set run.until=600 --force", 0);
  EXPECT_NE(read("a.h5").find("snapshots/0000"), nullptr);
}

}  // namespace cradle::tests::remedies_test
