// The manual, tools/manual/, describes this program: its quotations are what the program prints, it has every command
// and every option, and it names every group, dataset and attribute of result files.

#include "cradle/tests/tools/cases.hpp"

namespace cradle::tests::manual_test {

using Names = std::set<std::string>;

class Manual : public ProgramTest {
 protected:
  // From a headline of the page of commands to the next one.
  std::string section(const std::string& headline) const {
    const auto begin = commands_page.find("\n## " + headline + "\n");
    if (begin == commands_page.npos) return {};
    return commands_page.substr(begin + 1, commands_page.find("\n#", begin + 1) - begin);
  }

  const std::string commands_page = contents(test::source_folder + "/tools/manual/commands.md");
  const std::string files_page = contents(test::source_folder + "/tools/manual/files.md");
};

TEST_F(Manual, QuotesWhatTheProgramPrints) {
  shell("bash " + test::source_folder + "/tools/manual.sh --check \"$(command -v cradle)\"", 0);
}

TEST_F(Manual, HasEveryCommandAndItsOptions) {
  Names commands;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder + "/tools/commands"))
    commands.merge(matches(contents(entry.path()), R"re(program\.add\(\s*"([a-z]+)")re"));
  EXPECT_GE(commands.size(), 11U);
  const std::string option_lines = R"(\n +(-[^\n]*))", option = R"((--[a-z]+))";
  const Names common = matches(section("Options of every command that reads a SCENE"), option);
  for (const std::string& command : commands) {
    const std::string written = section("cradle " + command);
    EXPECT_NE(written, "") << "tools/manual/commands.md has no section on cradle " << command << ": write it";
    const Printed help = shell("cradle " + command + " --help", 0);
    Names has, documented = matches(written, option);
    for (const std::string& line : matches(help.out, option_lines)) has.merge(matches(line, option));
    has.erase("--help");
    if (has.contains("--set")) documented.insert(common.begin(), common.end());
    EXPECT_EQ(has, documented) << "options of cradle " << command << ", and those that tools/manual/commands.md has";
  }
}

TEST_F(Manual, HasEveryExitStatusAndSoDoHelpAndTheManualPage) {
  Names statuses = matches(contents(test::source_folder + "/tools/support/errors.hpp"), R"( = ([0-9]+),)");
  statuses.insert("141");  // what shells show of a program that SIGPIPE has ended
  const std::string page = shell("cradle manual", 0).out, help = shell("cradle --help", 0).out,
                    number = R"(\b([0-9]+)\b)";
  const auto begin = page.find(".SH EXIT STATUS");
  EXPECT_EQ(matches(page.substr(begin, page.find(".SH", begin + 1) - begin), number), statuses);
  EXPECT_EQ(matches(help.substr(help.find("Exit status")), number), statuses);
  EXPECT_EQ(matches(section("Exit status"), R"([|,] ([0-9]+)\b)"), statuses);
}

TEST_F(Manual, NamesEverythingInResultFiles) {
  const Names documented = matches(files_page, "`/?([A-Za-z_0-9/.]+)`");
  const auto expect = [&](const std::string& name, const std::string& file) {
    EXPECT_TRUE(documented.contains(name))
        << file << " holds " << name << ", tools/manual/files.md does not name it: add it there";
  };
  std::size_t groups = 0;
  for (const ListedCase& listed : cases_in("manual_results.txt")) {
    std::istringstream head(listed.name());
    int status = 0;
    std::string file, command = listed.below_name();
    head >> status >> file;
    shell(command + " --quiet -o " + file + ".h5", status);
    const tools::Result result = read(file + ".h5");
    for (const auto& [name, value] : result.attributes) expect(name, file);
    for (const tools::Group& group : result.groups) {
      ++groups;
      std::string name = std::regex_replace(group.name, std::regex("^points/[0-9]{4}/"), "");
      name = std::regex_replace(name, std::regex("[0-9]{4}"), "NNNN");
      const bool quantity = group.find("mean") != nullptr && !name.starts_with("ensemble/nodes");
      if (name.starts_with("ensemble/spread/"))
        name = "ensemble/spread/series/QUANTITY";
      else if (quantity)
        name = "ensemble/.../QUANTITY";
      if (name != "ensemble/nodes") expect(name, file);
      const bool of_points = name == "sweep";  // one column for every number of a replica
      for (const auto& [attribute, value] : group.attributes)
        expect(of_points ? "label_0000" : attribute, file + "/" + group.name);
      for (const tools::Column& column : group.columns)
        if (!of_points) expect(column.name, file + "/" + group.name);
    }
  }
  EXPECT_GT(groups, 40U);
}

}  // namespace cradle::tests::manual_test
