// Keys, commands and options that messages and help name exist: every key is in the table of keys, every command is one
// of the program's, and its options are options of that command.
#include <regex>
#include <set>
#include <string>

#include "cradle/tests/tools/program.hpp"

namespace cradle::tests::messages_test {

using Names = std::set<std::string>;

// The texts between quotes in a source of the program, those that follow each other as one.
std::string texts(const std::string& source) {
  static const std::regex quoted(R"re("((?:[^"\\\n]|\\.)*)")re"), between(R"("\s*\n\s*")");
  static const std::regex includes("#include[^\n]*");
  const std::string joined = std::regex_replace(std::regex_replace(source, includes, ""), between, "");
  std::string found;
  for (std::sregex_iterator match(joined.begin(), joined.end(), quoted), end; match != end; ++match)
    found += (*match)[1].str() + "\n";
  return found;
}

class Messages : public ProgramTest {
 protected:
  Messages() {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_folder + "/tools"))
      if (const auto kind = entry.path().extension(); kind == ".cpp" || kind == ".hpp") all += texts(contents(entry));
    EXPECT_GT(all.size(), 20000U);
  }
  std::string all;
};

TEST_F(Messages, NameKeysThatThereAre) {
  const Names keys = matches("\n" + shell("cradle scenes --keys").out, R"(\n([a-z_.]+)  \()");
  ASSERT_GT(keys.size(), 60U);
  const std::string key = R"(\b((?:law|initial|run|output|walls|gravity|sweep)\.[a-z_]+(?:\.[a-z_]+)*)(?![a-z0-9]))";
  for (const std::string& name : matches(all, key)) {
    const auto table = keys.lower_bound(name + ".");
    EXPECT_TRUE(keys.contains(name) || (table != keys.end() && table->starts_with(name + "."))) << name;
  }
}

TEST_F(Messages, NameCommandsAndOptionsThatThereAre) {
  const std::string help = shell("cradle --help").out;
  const Names commands = matches(help, R"(\n  ([a-z]+) )");
  ASSERT_GT(commands.size(), 15U);
  for (const std::string& line : matches(all, R"((?:`|"|^)(cradle [a-z]+[^`\n]*))")) {
    const std::string command = *matches(line, "^cradle ([a-z]+)").begin();
    ASSERT_TRUE(commands.contains(command)) << line;
    const Names options = matches(shell("cradle " + command + " --help").out, "(--[a-z]+)");
    for (const std::string& option : matches(line.substr(0, line.find('&')), "(--[a-z]+)"))
      EXPECT_TRUE(options.contains(option)) << line;
  }
}

}  // namespace cradle::tests::messages_test
