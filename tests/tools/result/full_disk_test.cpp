// A full disk: a message and status 4; the old file stays, and computed results are kept. (Limits on the size of files:
// tests/tools/outputs.txt.)

#include <algorithm>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::full_disk_test {

class FullDisk : public ProgramTest {
 protected:
  // Runs a command in a folder, `disk`, on a file system of 64 kB that no one else sees; $HERE is the test's folder.
  // Status 77 where the system does not allow one.
  Printed on_small_disk(const std::string& command) const {
    write("command", "mkdir -p disk; mount -t tmpfs -o size=64k none disk || exit 77; HERE=$PWD; cd disk\n" + command);
    return shell("unshare -rm true || exit 77; unshare -rm sh ../\"$(basename \"$PWD\")\"/command");
  }
};

constexpr const char* too_large =
    "cradle run fig2 --quiet --force --set initial.particles=4000 --set run.until=20 --set output.events=true "
    "--set output.snapshots=[5,10,15,20] --set output.checkpoint.every_seconds=1e-9 -o a.h5";

TEST_F(FullDisk, RunKeepsItsResultElsewhere) {
  const Printed run = on_small_disk("echo old > a.h5; mkdir $HERE/tmp; export TMPDIR=$HERE/tmp; " +
                                    std::string(too_large) + "; status=$?; cat a.h5; ls -A; exit $status");
  if (run.status == 77) GTEST_SKIP() << "no file system of our own here: " << run.err;
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_EQ(run.out, "old\na.h5\na.h5.checkpoint\na.h5.part\n");
  EXPECT_TRUE(begins(run.err, "a.h5.checkpoint: could not be written (found No space left on device): "));
  const auto kept =
      matches(run.err, R"(cradle: a\.h5: could not be written \(found No space left on device\): check the )"
                       R"(folder and the space on its disk; what was computed is in ([^,]*),)");
  ASSERT_EQ(kept.size(), 1U) << run.err;
  EXPECT_NE(tools::read_result(*kept.begin()).find("snapshots/0003"), nullptr);
}

TEST_F(FullDisk, WhereNothingCanBeKeptTheMessageSaysSo) {
  const Printed run = on_small_disk("TMPDIR=$PWD " + std::string(too_large));
  if (run.status == 77) GTEST_SKIP() << "no file system of our own here: " << run.err;
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_TRUE(has(run.err, "it could not be kept elsewhere either: "));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 2) << "the checkpoint's, and this: " << run.err;
}

}  // namespace cradle::tests::full_disk_test
