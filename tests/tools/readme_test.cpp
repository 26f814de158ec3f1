// Every command that the README shows under ```console is run, one after another in one folder, and must succeed.

#include <sstream>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests {
namespace readme_test {

class Readme : public ProgramTest {};

TEST_F(Readme, CommandsSucceedAsPrinted) {
  std::istringstream readme(contents(test::source_folder + "/README.md"));
  std::string line;
  bool console = false;
  int commands = 0;
  while (std::getline(readme, line)) {
    if (line.starts_with("```"))
      console = line == "```console";
    else if (console && line.starts_with("cradle ")) {
      const Printed run = shell(line);
      EXPECT_EQ(run.status, 0) << line << "\n" << run.err;
      ++commands;
    }
  }
  EXPECT_GE(commands, 10);
  for (const auto* made : {"fig2.h5", "fig2.png", "csv/series.csv", "theory.txt", "core.h5", "fig4.h5", "keys.txt"})
    EXPECT_TRUE(std::filesystem::exists(folder / made)) << made;
}

}  // namespace readme_test
}  // namespace cradle::tests
