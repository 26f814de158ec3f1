#pragma once
// Runs the program as a user does: a shell command in a folder of its own, with exit status and what it printed.

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "cradle/tests/places.hpp"

namespace cradle::tests {

struct Printed {
  int status;
  std::string out, err;
};

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ProgramTest : public testing::Test {
 protected:
  ProgramTest() {
    std::string name = (std::filesystem::temp_directory_path() / "cradle-test-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) folder = name;
  }
  ~ProgramTest() override {
    std::error_code ignored;
    if (!folder.empty()) std::filesystem::remove_all(folder, ignored);
  }

  // `command` as typed in the test's folder; `cradle` is the program that was built.
  Printed shell(const std::string& command) const {
    const std::string line = "cd '" + folder.string() + "' && PATH=\"" + test::build_folder + "/tools:$PATH\" && { " +
                             command + "\n} >.out 2>.err </dev/null";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / ".out"), contents(folder / ".err")};
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream stream(folder / name, std::ios::binary);
    stream << text;
  }

  std::filesystem::path folder;
};

// Runs that are interfered with must not end by themselves, however quick the machine is: this one would make 1e18
// collisions. It keeps its state ten times a second.
inline std::string endless_run(const std::string& file) {
  return "cradle run cooling --quiet --set law.type=inelastic --set law.restitution=1 --set initial.particles=2000 "
         "--set run.until=1e15 --set output.checkpoint.every_seconds=0.1 -o " +
         file;
}

// Puts the command before it in the background, its process being $pid, and waits until its state has collisions in it.
inline std::string until_collisions(const std::string& file) {
  return " & pid=$!; until cradle info " + file +
         ".checkpoint 2>.not-yet | grep -q ', [1-9][0-9]* collisions'; do sleep 0.01; done; ";
}

// Initial perturbation of the published fixtures: the splitmix64 finaliser of the particle's number.
inline std::uint64_t hash(std::uint64_t i) {
  std::uint64_t z = i + 0x9E3779B97F4A7C15;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

}  // namespace cradle::tests
