// The first hour: `cradle` alone suggests commands, and they work; `new` lists every key that its scene could use; the
// manual page has every command, option and key. (More of it: tests/tools/outputs.txt.)

#include <sstream>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::first_hour_test {

using FirstHour = ProgramTest;

TEST_F(FirstHour, ProgramAloneSaysWhatToTryAndItWorks) {
  const Printed alone = shell("cradle", 2);
  EXPECT_EQ(alone.err, "cradle: no command: give one, see `cradle --help`\n");
  std::istringstream lines(alone.out);
  std::vector<std::string> tried;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("  cradle ")) tried.push_back(line.substr(2, line.find("  ", 2) - 2));
  ASSERT_EQ(tried.size(), 5U) << alone.out;
  for (const auto& command : tried) {
    const Printed run = shell(command);
    if (run.err.find("no Python with") != std::string::npos) continue;  // all but pictures and reports goes without
    EXPECT_EQ(run.status, 0) << command << "\n" << run.err;
  }
  for (const auto* made : {"fig2.h5", "shock.toml"}) EXPECT_TRUE(exists(made)) << made;
}

TEST_F(FirstHour, NewSceneListsEveryKeyThatItCouldUse) {
  const Printed made = shell("cradle new", 0);
  EXPECT_EQ(made.out, "wrote shock.toml: change it, then `cradle run shock.toml`\n");
  const std::string text = contents(folder / "shock.toml");
  tools::Scene scene = tools::read_scene(path("shock.toml"), {});
  for (const tools::Field& field : tools::scene_fields()) {
    if (!field.when->holds(scene)) continue;
    EXPECT_TRUE(has(text, fmt::format("# {} ({})\n", field.doc, facts(field)))) << field.key;
  }
  shell("cradle run shock.toml --quiet", 0);
}

TEST_F(FirstHour, ManualPageHasEveryCommandOptionAndKey) {
  const Printed page = shell("cradle manual", 0);
  EXPECT_TRUE(begins(page.out, ".TH CRADLE 1 "));
  const std::set<std::string> commands = matches(shell("cradle --help").out, R"(\n  ([a-z]+) )");
  EXPECT_GE(commands.size(), 19U);
  for (const std::string& command : commands) EXPECT_TRUE(has(page.out, ".SS cradle " + command)) << command;
  for (const auto* option : {"\\-\\-replicas N", "\\-o, \\-\\-output", "\\-\\-vary", "\\-\\-rtol"})
    EXPECT_TRUE(has(page.out, option));
  for (const tools::Field& field : tools::scene_fields())
    EXPECT_TRUE(has(page.out, "\n.B " + std::string(field.key) + "\n")) << field.key;
  if (shell("command -v groff").status != 0) GTEST_SKIP() << "no groff: how the page is set was not checked";
  const Printed set = shell("cradle manual | groff -man -ww -Tutf8 > page.txt");
  EXPECT_EQ(set.err, "");
  EXPECT_GT(std::filesystem::file_size(folder / "page.txt"), 10000U);
}

}  // namespace cradle::tests::first_hour_test
