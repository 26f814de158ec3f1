// A disk that is full: a message, status 4, what was there before is there still, and what was computed is kept.

#include <algorithm>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/result/reader.hpp"

namespace cradle::tests {
namespace full_disk_test {

class FullDisk : public ProgramTest {
 protected:
  // Runs a command in a folder, `disk`, on a file system of 64 kB that no one else sees; $HERE is the test's folder.
  // Status 77 where the system lets nobody have one.
  Printed on_small_disk(const std::string& command) const {
    write("command", "mkdir -p disk; mount -t tmpfs -o size=64k none disk || exit 77; HERE=$PWD; cd disk\n" + command);
    return shell("unshare -rm true || exit 77; unshare -rm sh ../\"$(basename \"$PWD\")\"/command");
  }
};

constexpr const char* too_large = "cradle run fig2 --quiet --set initial.particles=4000 --set run.until=20 --set "
                                  "output.snapshots=[5,10,15,20] --set output.events=true "
                                  "--set output.checkpoint.every_seconds=1e-9 -o a.h5";

TEST_F(FullDisk, RunKeepsItsResultElsewhere) {
  const Printed run = on_small_disk("echo old > a.h5; mkdir $HERE/tmp; export TMPDIR=$HERE/tmp; " +
                                    std::string(too_large) + "; status=$?; cat a.h5; ls -A; exit $status");
  if (run.status == 77) GTEST_SKIP() << "no file system of our own here: " << run.err;
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_EQ(run.out, "old\na.h5\na.h5.checkpoint\na.h5.part\n");
  EXPECT_EQ(run.err.rfind("a.h5.checkpoint: could not be written (found No space left on device): ", 0), 0U) << run.err;
  const std::string begin = "cradle: a.h5: could not be written (found No space left on device): check the folder and "
                            "the space on its disk; what was computed is in ";
  const std::size_t at = run.err.find(begin);
  ASSERT_NE(at, std::string::npos) << run.err;
  const std::size_t from = at + begin.size();
  const std::string kept = run.err.substr(from, run.err.find(',', from) - from);
  EXPECT_NE(tools::read_result(kept).find("snapshots/0003"), nullptr);
}

TEST_F(FullDisk, WhereNothingCanBeKeptTheMessageSaysSo) {
  const Printed run = on_small_disk("TMPDIR=$PWD " + std::string(too_large));
  if (run.status == 77) GTEST_SKIP() << "no file system of our own here: " << run.err;
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_NE(run.err.find("it could not be kept elsewhere either: "), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 2) << "the checkpoint's, and this: " << run.err;
}

// Without a file system of its own: files may grow to 8 blocks only.
TEST_F(FullDisk, LimitOnFileSizesIsNoCrash) {
  const Printed run = shell("echo old > a.h5; ulimit -f 8; " + std::string(too_large));
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_NE(run.err.find("a.h5: could not be written (found File too large)"), std::string::npos) << run.err;
  EXPECT_EQ(contents(folder / "a.h5"), "old\n");
}

TEST_F(FullDisk, EnsembleContinuesFromItsJournal) {
  const std::string ensemble = "cradle ensemble fig2 --quiet --set initial.particles=100 --set run.until=20 --set "
                               "output.snapshots=[] --set output.profiles.times=[] --replicas 12 -o ";
  ASSERT_EQ(shell(ensemble + "whole.h5").status, 0);
  // So large are journals of some replicas, but not the file.
  const Printed full = shell("ulimit -f 40; " + ensemble + "a.h5");
  EXPECT_EQ(full.status, 4) << full.err;
  EXPECT_NE(full.err.find("could not be written (found File too large)"), std::string::npos) << full.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5"));
  const Printed again = shell(ensemble + "a.h5");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(contents(folder / "a.h5") == contents(folder / "whole.h5"));
}

}  // namespace full_disk_test
}  // namespace cradle::tests
