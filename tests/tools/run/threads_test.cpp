// `cradle run --threads`. Proves: result files have the same bytes for any number of threads, if a run is cut into
// segments, in double and in wider types; and events are those of the plain loop. (Whether threads will be used is said
// beforehand: outputs.txt.)

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::run_threads_test {

class RunThreads : public ProgramTest {
 protected:
  RunThreads() {
    write("ring.toml", "[law]\ntype = \"wet\"\nloss = 0.01\n[initial]\ntype = \"ring\"\nparticles = 4000\nseed = 3\n"
                       "[run]\nuntil = 30\n[output]\nsnapshots = [10, 30]\nseries = { points = 7 }\n");
  }
};

TEST_F(RunThreads, NeverChangeAResult) {
  for (const std::string scene : {"fig2 --set initial.particles=4000 --set run.until=1500", "ring.toml"})
    for (const std::string precision : {"double", "double-double", "mpfr"}) {
      const std::string run = "cradle run " + scene + " --set run.precision=" + precision;
      expect_same_on_threads(run);
      shell(run + " --quiet -o any.h5", 0);
      expect_same("1.h5", "any.h5");
      shell("rm any.h5", 0);
    }
}

// Those of a run that stops for so many samples that it goes one by one.
TEST_F(RunThreads, NeverChangeTheEvents) {
  const std::string dry = "fig2 --set initial.particles=4000 --set output.snapshots=[] --set run.until=",
                    walls = "fig2 --set initial.particles=1200 --set walls.left.position=-600 --set "
                            "walls.right.position=600 --set walls.right.temperature=0.1 --set run.until=300",
                    wet = "ring.toml --set run.until=10 --set output.snapshots=[]";
  for (const auto& [scene, precision] :
       {std::pair(dry + "1200", "double"), {dry + "650", "mpfr"}, {walls, "double"}, {wet, "double"}, {wet, "mpfr"}}) {
    SCOPED_TRACE(scene + " in " + precision);
    const std::string run = "cradle run " + scene + " --set output.events=true --set run.precision=" + precision;
    expect_same_on_threads(run);
    shell(run + " --quiet --force --set output.series.points=4000 -o plain.h5", 0);
    const auto events = [&](const char* file) { return read(file).find("events")->columns; };
    const auto found = events("1.h5"), wanted = events("plain.h5");
    ASSERT_GT(found.front().rows(), 5000U);
    for (std::size_t k = 0; k < wanted.size(); ++k)
      EXPECT_TRUE(found.at(k).values == wanted[k].values) << wanted[k].name;
  }
}

}  // namespace cradle::tests::run_threads_test
