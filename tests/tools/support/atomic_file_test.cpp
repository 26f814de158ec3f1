// Writing files: the old file stays until the new one is complete, after any failure; one program at a time writes a
// file; links are followed; no other file is touched.

#include "cradle/tools/support/atomic_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include "cradle/tests/tools/faults.hpp"
#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::atomic_file_test {

namespace fs = std::filesystem;
using tools::FileClaim;
using tools::replace_file;

class AtomicFile : public ProgramTest {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  template <class Work> static std::string refusal(const Work& work) { return tests::refusal(tools::Exit::io, work); }
};

TEST_F(AtomicFile, ReplacesAllOrNothing) {
  write("a", "old");
  replace_file(path("a"), "new");
  EXPECT_EQ(contents(folder / "a"), "new");
  {
    const SmallFiles full;
    EXPECT_EQ(refusal([&] { replace_file(path("a"), std::string(20000, 'x')); }),
              path("a") + ": could not be written (found File too large): check the folder and the space on its disk");
  }
  EXPECT_EQ(contents(folder / "a"), "new");
  EXPECT_EQ(files(), 1U) << "nothing is left over";
}

TEST_F(AtomicFile, KeepsWhoMayReadIt) {
  write("a", "old");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  replace_file(path("a"), "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(AtomicFile, LeavesFilesOfOthersAlone) {
  for (const auto* name : {"a.new", ".a.cradle-1-0", "a.part", "a.lock"}) write(name, "mine");
  // What this process itself has left behind before it crashed.
  write(".a.cradle-" + std::to_string(::getpid()) + "-0", "mine");
  replace_file(path("a"), "new");
  EXPECT_EQ(files(), 6U);
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_EQ(contents(entry.path()), entry.path().filename() == "a" ? "new" : "mine") << entry.path();
}

TEST_F(AtomicFile, FollowsLinks) {
  fs::create_directory(folder / "there");
  write("there/target", "old");
  fs::create_symlink("there/target", folder / "link");
  fs::create_symlink("link", folder / "link to link");
  fs::create_symlink("there/nothing", folder / "dangling");
  replace_file(path("link to link"), "new");
  replace_file(path("dangling"), "made");
  EXPECT_TRUE(fs::is_symlink(folder / "link") && fs::is_symlink(folder / "link to link") &&
              fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(contents(folder / "there/target"), "new");
  EXPECT_EQ(contents(folder / "there/nothing"), "made");
  // Two names of one file have one writer.
  const FileClaim claim(path("link"));
  EXPECT_TRUE(has(refusal([&] { FileClaim{path("there/target")}; }), "another program"));
  fs::create_symlink("round", folder / "round");
  EXPECT_EQ(refusal([&] { replace_file(path("round"), ""); }),
            path("round") + ": cannot be written (found links that lead nowhere): give another -o FILE");
}

TEST_F(AtomicFile, RefusesWhatIsNoFile) {
  ASSERT_EQ(::mkfifo(path("fifo").c_str(), 0600), 0);
  fs::create_directory(folder / "folder");
  fs::create_symlink("fifo", folder / "link");
  for (const auto& refused : {std::pair{path("fifo"), "a FIFO"},
                              {path("link"), "a FIFO"},
                              {path("folder"), "a folder of that name"},
                              {path("folder/"), "a folder of that name"}}) {
    const std::string& name = refused.first;
    const std::string message = name + ": cannot be written (found " + refused.second + "): give another -o FILE";
    EXPECT_EQ(refusal([&] { replace_file(name, "text"); }), message);
    EXPECT_EQ(refusal([&] { FileClaim{name}; }), message);
  }
  EXPECT_TRUE(fs::is_fifo(folder / "fifo"));
  // Only asked about: were it not refused, root would lose it.
  EXPECT_EQ(refusal([] { tools::file_behind("/dev/null"); }),
            "/dev/null: cannot be written (found a device): give another -o FILE");
  EXPECT_TRUE(has(refusal([&] { FileClaim{path("no/such/folder")}; }), "No such file or directory"));
}

TEST_F(AtomicFile, HasOneWriterAtATime) {
  std::optional<FileClaim> first(path("a"));
  const std::string message = refusal([&] { FileClaim{path("a")}; });
  EXPECT_TRUE(begins(message, path("a") + ": another program is writing this file (found process "));
  EXPECT_TRUE(has(message, std::to_string(::getpid())));
  const FileClaim other(path("b"));
  first.reset();
  const FileClaim second(path("a"));
}

TEST_F(AtomicFile, ClaimTakesAwayWhatAWriterThatWasKilledHasLeft) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);  // nobody has its number now
  const std::string dead = ".cradle-" + std::to_string(child) + "-0",
                    living = ".cradle-" + std::to_string(getpid()) + "-7";
  const std::vector<std::string> left{".a.h5" + dead, ".a.h5.checkpoint" + dead, ".a.h5.part" + dead},
      others{".a.h5" + living, ".b.h5" + dead, "a.h5" + dead, ".a.h5.cradle-x"};
  for (const auto& name : left) write(name, "half");
  for (const auto& name : others) write(name, "theirs");
  { const FileClaim claim(path("a.h5")); }
  for (const auto& name : left) EXPECT_FALSE(fs::exists(folder / name)) << name;
  for (const auto& name : others) EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST_F(AtomicFile, ClaimLeavesNothingBehindAndOutlivesNoCrash) {
  { const FileClaim claim(path("a")); }
  EXPECT_EQ(files(), 0U);
  write(".a.cradle-lock", "process 1 on a machine that is gone");
  { const FileClaim claim(path("a")); }
  EXPECT_EQ(files(), 0U);
}

}  // namespace cradle::tests::atomic_file_test
