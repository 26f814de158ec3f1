// On a processor without AVX2 the program of the preset release says so and what to do, and ends with its own status,
// before it executes an instruction that is missing. Such processors are emulated (Debian: qemu-user).
#include <algorithm>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::processor_test {

using Processor = ProgramTest;

TEST_F(Processor, OlderThanTheBuildIsReported) {
  if (shell("command -v qemu-x86_64").status != 0) GTEST_SKIP() << "no qemu-x86_64 (Debian: qemu-user)";
  if (!has(shell("cradle --version").out, "-march=x86-64-v3")) GTEST_SKIP() << "not compiled for x86-64-v3";
  const auto on = [this](const std::string& processor) {
    return shell("qemu-x86_64 -cpu " + processor + " \"$(command -v cradle)\" --version");
  };
  const Printed older = on("Nehalem");
  EXPECT_EQ(older.status, 6) << older.err;
  EXPECT_EQ(older.out, "");
  EXPECT_EQ(std::count(older.err.begin(), older.err.end(), '\n'), 1) << older.err;
  EXPECT_TRUE(has(older.err, "--preset portable"));
  EXPECT_EQ(on("Haswell").status, 0);
}

}  // namespace cradle::tests::processor_test
