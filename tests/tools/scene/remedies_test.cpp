// Messages that advise something: each is followed as a user would, and then the command succeeds. What the command
// line leaves out of a scene is said.

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::remedies_test {

class Remedies : public ProgramTest {};

TEST_F(Remedies, AreRightForMisplacedAndUnknownKeys) {
  struct Case {
    const char *wrong, *message, *remedied;
  };
  for (const auto& [wrong, message, remedied] : {
           Case{"fig2 --set particles=100", "did you mean initial.particles?", "fig2 --set initial.particles=100"},
           Case{"fig2 --set law.type=wet --set law.loss=1e-4", "remove it by `--set law.cutoff=`",
                "fig2 --set law.type=wet --set law.loss=1e-4 --set law.cutoff= --set law.restitution="},
           Case{"fig2 --set initial.type=ring --set initial.length=8000",
                "remove it by `--set initial.spacing=`, it belongs to initial.type = \"cold\" or initial.type = "
                "\"rows\" "
                "without [initial.left] and [initial.right] or initial.type = \"clusters\"",
                "fig2 --set initial.type=ring --set initial.length=8000 --set initial.spacing= --set initial.speed="},
           Case{"fig2 --set initial.type=ring --set initial.length=8000 --set initial.spacing=2",
                "remove it, it belongs",
                "fig2 --set initial.type=ring --set initial.length=8000 --set initial.spacing= --set initial.speed="},
       }) {
    const Printed refused = shell(std::string("cradle check ") + wrong, 2);
    EXPECT_TRUE(has(refused.err, message)) << refused.err;
    shell(std::string("cradle check ") + remedied, 0);
  }
}

TEST_F(Remedies, NameTheSceneThatIsThere) {
  shell("cradle new shock.toml --from fig5 && mkdir deep && cp shock.toml deep", 0);
  EXPECT_TRUE(has(shell("cradle run shokc.toml", 4).err, "bundled scene): did you mean shock.toml?"));
  EXPECT_TRUE(has(shell("cradle run deep/shok.toml", 4).err, "did you mean deep/shock.toml?"));
  EXPECT_TRUE(has(shell("cradle run colapse3", 4).err, "did you mean collapse3?"));
  EXPECT_TRUE(has(shell("cradle run something/else.toml", 4).err, "one of the names that `cradle scenes` lists"));
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
