// The manual, tools/manual/, describes this program: its quotations are what the program prints, it has every command
// and every option, and it names every group, dataset and attribute of result files.

#include <algorithm>
#include <regex>
#include <set>
#include <string>

#include "cradle/tests/tools/program.hpp"

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
    commands.merge(matches(contents(entry.path()), R"re(program\.add(?:_subcommand)?\(\s*"([a-z]+)")re"));
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

TEST_F(Manual, NamesEverythingInResultFiles) {
  const std::string small = " --quiet --set initial.particles=60 --set run.until=40 ";
  for (const std::string& command :
       {"cradle run fig2 -o dry.h5 --set output.snapshots=[20] --set output.events=true" + small,
        "cradle run fig6 -o wet.h5 --set output.snapshots=[] --set output.profiles.times=[] --set output.masses=[40] "
        "--set output.zone.from=20 --set output.scenario=true" +
            small,
        "cradle run classics/heat_wall -o walls.h5 --set walls.right.restitution=0.9 --set output.averages.every=1 "
        "--set "
        "'output.histograms=[\"closing_speed\"]' --set output.snapshots=[] --set output.correlations.every=1 --set "
        "output.structure.every=2 --set output.structure.times=[9] --set output.pair_distribution.every=2 --set "
        "output.pair_distribution.times=[9] --set output.pair_distribution.distance=0.2" +
            small,
        std::string("cradle run fig9 -o model.h5 --quiet --set run.until=10"),
        std::string("cradle trust collapse3 -o trust.h5 --quiet --digits 16,31"),
        std::string("cradle words 3 ab -o words.h5 --quiet --digits 10"),
        std::string("cradle threshold collapse3 -o threshold.h5 --quiet --vary law.restitution=0.05:0.1 --digits 3"),
        "cradle ensemble fig2 -o ensemble.h5 --replicas 3 --spread energy=0:10:5 --set output.profiles.times=[30]" +
            small,
        "cradle sweep fig8 -o sweep.h5 --vary law.loss=0.01,0.02 --replicas 2 --set output.zone.from=20" + small}) {
    shell(command, 0);
  }
  shell("cradle run collapse3 -o collapse.h5 --quiet --set output.word=ab", 3);

  const Names documented = matches(files_page, "`/?([A-Za-z_0-9/.]+)`");
  const auto expect = [&](const std::string& name, const std::string& file) {
    EXPECT_TRUE(documented.contains(name))
        << file << " holds " << name << ", tools/manual/files.md does not name it: add it there";
  };
  std::size_t groups = 0;
  for (const char* file :
       {"dry", "wet", "walls", "model", "trust", "words", "threshold", "collapse", "ensemble", "sweep"}) {
    const tools::Result result = tools::read_result((folder / (std::string(file) + ".h5")).string());
    for (const auto& [name, value] : result.attributes) expect(name, file);
    for (const tools::Group& group : result.groups) {
      ++groups;
      std::string name = std::regex_replace(group.name, std::regex("^points/[0-9]{4}/"), "");
      name = std::regex_replace(name, std::regex("[0-9]{4}"), "NNNN");
      const bool quantity = std::any_of(group.columns.begin(), group.columns.end(),
                                        [](const auto& column) { return column.name == "mean"; }) &&
                            !name.starts_with("ensemble/nodes");
      if (name.starts_with("ensemble/spread/"))
        name = "ensemble/spread/series/QUANTITY";
      else if (quantity)
        name = "ensemble/.../QUANTITY";
      if (name != "ensemble/nodes") expect(name, file);
      const bool of_points = name == "sweep";  // one column for every number of a replica
      for (const auto& [attribute, value] : group.attributes)
        expect(of_points ? "label_0000" : attribute, file + ("/" + group.name));
      for (const tools::Column& column : group.columns)
        if (!of_points) expect(column.name, file + ("/" + group.name));
    }
  }
  EXPECT_GT(groups, 40U);
}

}  // namespace cradle::tests::manual_test
