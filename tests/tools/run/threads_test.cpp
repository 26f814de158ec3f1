// `cradle run --threads`. Proves: result files are the same to the byte whatever the number of threads, where a run is
// cut into segments, in double and in wider types; and `check` says beforehand whether threads will do anything.

#include <string>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests {
namespace run_threads_test {

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
      std::string first;
      for (const std::string threads : {"1", "2", "3", "8"}) {
        const std::string file = scene.substr(0, 4) + precision + threads + ".h5";
        const std::string run = "cradle run " + scene + " --quiet --set run.precision=" + precision;
        ASSERT_EQ(shell(run + " --threads " + threads + " -o " + file).status, 0);
        if (first.empty()) first = contents(folder / file);
        EXPECT_EQ(contents(folder / file), first) << file;
      }
    }
}

TEST_F(RunThreads, AreWhatCheckPrintsBeforehand) {
  const auto printed = [&](const std::string& scene) { return shell("cradle check --threads 2 " + scene).out; };
  EXPECT_NE(printed("fig2").find("threads: 2, about 1.8 times as fast as one once all particles are active\n"),
            std::string::npos);
  EXPECT_NE(printed("fig11").find("threads: one does the work (particles that merge)\n"), std::string::npos);
  EXPECT_NE(printed("ring.toml").find("threads: 2, about 1.8 times"), std::string::npos);
  EXPECT_NE(printed("fig2 --set initial.particles=200").find("(few particles)"), std::string::npos);
  EXPECT_NE(printed("fig2 --set run.coordinates=absolute").find("(absolute coordinates)"), std::string::npos);
  EXPECT_NE(printed("fig2 --set output.events=true").find("(every collision is recorded, in order)"),
            std::string::npos);
  EXPECT_NE(printed("collapse3").find("(a collapse to be found)"), std::string::npos);
}

}  // namespace run_threads_test
}  // namespace cradle::tests
