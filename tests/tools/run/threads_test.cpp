// `cradle run --threads`. Proves: result files have the same bytes for any number of threads, if a run is cut into
// segments, in double and in wider types; and `check` says beforehand whether threads will be used.

#include <string>

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
      std::string first;
      for (const std::string threads : {"1", "2", "3", "8"}) {
        const std::string file = scene.substr(0, 4) + precision + threads + ".h5";
        const std::string run = "cradle run " + scene + " --quiet --set run.precision=" + precision;
        shell(run + " --threads " + threads + " -o " + file, 0);
        if (first.empty()) first = contents(folder / file);
        EXPECT_EQ(contents(folder / file), first) << file;
      }
    }
}

TEST_F(RunThreads, AreWhatCheckPrintsBeforehand) {
  const auto printed = [&](const std::string& scene) { return shell("cradle check --threads 2 " + scene).out; };
  EXPECT_TRUE(has(printed("fig2"), "threads: 2, about 1.8 times as fast as one once all particles are active\n"));
  EXPECT_TRUE(has(printed("fig11"), "threads: one does the work (particles that merge)\n"));
  EXPECT_TRUE(has(printed("ring.toml"), "threads: 2, about 1.8 times"));
  EXPECT_TRUE(has(printed("fig2 --set initial.particles=200"), "(few particles)"));
  EXPECT_TRUE(has(printed("fig2 --set run.coordinates=absolute"), "(absolute coordinates)"));
  EXPECT_TRUE(has(printed("fig2 --set output.events=true"), "(every collision is recorded, in order)"));
  EXPECT_TRUE(has(printed("collapse3"), "(a collapse to be found)"));
}

}  // namespace cradle::tests::run_threads_test
