// Two programs write to one name: the second is refused before it has done anything, at any time. (What is no
// file is refused: tests/tools/outputs.txt.)

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tests::two_writers_test {

// The second comes while the first one runs its first replica.
TEST_F(Ensembles, SecondOfTwoThatBeginAfreshIsRefused) {
  run("ensemble shock.toml --replicas 8 -o whole.h5");
  Printed second{-1, "", ""};
  const auto runner = [&](const Scene& replica, const tools::RunOptions& how) {
    if (second.status == -1) {
      EXPECT_FALSE(exists("a.h5"));
      second = shell("cradle ensemble shock.toml --first 4 --replicas 4 -o a.h5");
    }
    return tools::run_scene(replica, how);
  };
  const tools::EnsembleOptions options{
      .replicas = {0, 4}, .threads = 1, .progress = tools::ProgressLine::Show::never, .runner = runner};
  EXPECT_EQ(tools::run_ensemble(scene("shock.toml"), options, path("a.h5")).status, Exit::done);
  EXPECT_EQ(second.status, 4);
  EXPECT_TRUE(begins(second.err, "cradle: a.h5: another program is writing this file (found process "));
  // It comes again when the first one is done: nothing is lost.
  run("ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  EXPECT_EQ(read("a.h5").find("replicas")->columns.front().rows(), 8U);
}

TEST_F(Ensembles, OneRunAtATimeWritesToAName) {
  write("a.h5", "old");
  write("a.h5.new", "another user's");
  {
    const tools::FileClaim first(path("a.h5"));
    for (const auto* command : {"run shock.toml -o a.h5", "trust shock.toml --digits 16,31 -o a.h5",
                                "merge a.h5 a.h5 -o a.h5", "sweep shock.toml --vary law.cutoff=0,1 -o a.h5"})
      EXPECT_TRUE(has(shell(std::string("cradle ") + command, 4).err, "a.h5: another program is writing this file"));
    EXPECT_TRUE(contents(folder / "a.h5") == "old");
  }
  run("run shock.toml --quiet --force -o a.h5");
  EXPECT_NE(read("a.h5").find("series"), nullptr);
  EXPECT_EQ(contents(folder / "a.h5.new"), "another user's");
}

}  // namespace cradle::tests::two_writers_test
