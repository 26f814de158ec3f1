// Two programs write to one name: the second is refused before it has done anything, at any time. (What is no
// file is refused: tests/tools/outputs.txt.)

#include "cradle/tests/tools/ensemble/ensembles.hpp"
#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/support/atomic_file.hpp"

namespace cradle::tests::two_writers_test {

// The second comes when the first one is about to run its first replica.
TEST_F(Ensembles, SecondOfTwoThatBeginAfreshIsRefused) {
  struct First : tools::OneProcess {
    using OneProcess::OneProcess;
    int share(const std::vector<tools::JobRange>& jobs, const std::function<void(const tools::NextJob&)>& work,
              const std::function<void(std::uint64_t)>& others_took) override {
      begun();
      return OneProcess::share(jobs, work, others_took);
    }
    std::function<void()> begun;
  };
  Printed second{-1, "", ""};
  tools::Interrupt interrupt;
  First first(interrupt);
  first.begun = [&] {
    EXPECT_FALSE(exists("a.h5"));
    second = shell("cradle ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  };
  const tools::EnsembleOptions options{.replicas = {0, 4}, .progress = tools::ProgressLine::Show::never};
  EXPECT_EQ(tools::run_study(tools::ensemble_of(scene("shock.toml")), options, path("a.h5"), first).status, Exit::done);
  EXPECT_EQ(second.status, 4);
  EXPECT_TRUE(begins(second.err, "cradle: a.h5: another program is writing this file (found process "));
  // It comes again when the first one is done: nothing is lost.
  run("ensemble shock.toml --first 4 --replicas 4 -o a.h5");
  run("ensemble shock.toml --replicas 8 -o whole.h5");
  expect_same("whole.h5", "a.h5");
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
