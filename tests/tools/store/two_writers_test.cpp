// Two programs write to one name: the second is refused before it has done anything, at any time.

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tests::two_writers_test {

// The second comes while the first one runs its first replica.
TEST_F(Ensembles, SecondOfTwoThatBeginAfreshIsRefused) {
  run("ensemble shock.toml --replicas 8 -o whole.h5");
  Printed second{-1, "", ""};
  tools::EnsembleOptions options;
  options.replicas = {0, 4};
  options.threads = 1;
  options.progress = tools::ProgressLine::Show::never;
  const auto runner = options.runner;
  options.runner = [&](const Scene& replica, const tools::RunOptions& how) {
    if (second.status == -1) {
      EXPECT_FALSE(exists("a.h5"));
      second = shell("cradle ensemble shock.toml --first 4 --replicas 4 -o a.h5");
    }
    return runner(replica, how);
  };
  EXPECT_EQ(tools::run_ensemble(scene("shock.toml"), options, path("a.h5")).status, Exit::done);
  EXPECT_EQ(second.status, 4);
  EXPECT_TRUE(begins(second.err, "cradle: a.h5: another program is writing this file (found process "));
  // It comes again when the first one is done: nothing is lost.
  run("ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  EXPECT_EQ(result("a.h5").find("replicas")->columns.front().rows(), 8U);
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
  EXPECT_NE(result("a.h5").find("series"), nullptr);
  EXPECT_EQ(contents(folder / "a.h5.new"), "another user's");
}

TEST_F(Ensembles, FifosAreRefusedByNameAndLinksFollowed) {
  for (const auto* command : {"run shock.toml -o fifo", "ensemble shock.toml --replicas 2 -o fifo"}) {
    const Printed refused = shell(std::string("test -p fifo || mkfifo fifo; cradle ") + command, 4);
    EXPECT_TRUE(has(refused.err, ": cannot be written (found a FIFO"));
    EXPECT_TRUE(std::filesystem::is_fifo(folder / "fifo"));
  }
  for (const auto* command : {"info fifo", "export fifo --to csv", "merge fifo fifo -o a.h5"})
    shell(std::string("timeout 300 cradle ") + command, 4);
  write("a.h5", "old");
  std::filesystem::create_symlink("a.h5", folder / "link.h5");
  run("run shock.toml --quiet --force -o link.h5");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.h5"));
  EXPECT_NE(result("a.h5").find("series"), nullptr);
}

}  // namespace cradle::tests::two_writers_test
