// Every command that README shows under ```console is run, one after another in one folder, and must succeed. Those of
// the manual's pages are run by python/test_manual.py.

#include <sstream>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::readme_test {

class Readme : public ProgramTest {};

TEST_F(Readme, CommandsSucceedAsPrinted) {
  int commands = 0;
  std::istringstream text(contents(test::source_folder + "/README.md"));
  bool console = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```"))
      console = line == "```console";
    else if (console && line.starts_with("cradle ")) {
      const Printed run = shell(line);
      EXPECT_EQ(run.status, 0) << line << "\n" << run.err;
      ++commands;
    }
  }
  EXPECT_GE(commands, 15);
  for (const auto* made : {"fig2.h5", "fig2.png", "theory.txt", "fig4.h5", "keys.txt"})
    EXPECT_TRUE(exists(made)) << made;
}

}  // namespace cradle::tests::readme_test
