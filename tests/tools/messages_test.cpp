// Wrong input has the answers that stand in messages.txt: one message, with file, line and key, and nothing else is
// left behind. Commands print what stands in outputs.txt. Keys, commands and options that messages and help name exist:
// every key is in the table of keys, every command is one of the program's, and its options are options of that
// command.
#include "cradle/tests/tools/cases.hpp"
#include "cradle/tools/setup/list_file.hpp"
#include "cradle/tools/setup/read_scene.hpp"

namespace cradle::tests::messages_test {

using Names = std::set<std::string>;

struct Command {
  std::string typed;
  int status;
  Lines printed;  // each with its kind before it, as in outputs.txt
};

struct Input {
  std::size_t line;  // of the table, its first one
  std::map<std::string, Lines> files;
  Lines settings;
  std::vector<Command> commands;
  std::string message;
  int status;

  std::string text(const std::string& file) const {
    std::string all;
    for (const std::string& of_file : files.at(file)) all += of_file + "\n";
    return all;
  }
};

struct Inputs {
  std::string name;
  std::vector<Input> all;
};

void PrintTo(const Inputs& inputs, std::ostream* stream) { *stream << inputs.name; }

// Of a case of messages.txt or outputs.txt, whose heads describe their form.
Input input_of(const ListedCase& listed) {
  static const std::regex answer("=>(?: \\[([0-9])\\])?(?: (.*))?"), replacement("([0-9]+): ?(.*)"),
      command("\\$ (?:\\[([0-9]+)\\] )?(.*)");
  Input input{listed.number, {}, {}, {}, {}, 0};
  std::string name = "s.toml";
  std::set<std::size_t> replaced;
  bool answered = false;
  for (const std::string& line : listed.lines) {
    std::smatch match;
    if (answered) {
      input.message += line.substr(2);
    } else if (std::regex_match(line, match, answer)) {
      answered = true, input.message = match[2], input.status = match[1].matched ? std::stoi(match[1]) : 2;
    } else if (std::regex_match(line, match, command)) {
      input.commands.push_back({match[2], match[1].matched ? std::stoi(match[1]) : 0, {}});
    } else if (!input.commands.empty()) {
      input.commands.back().printed.push_back(line);
    } else if (line.starts_with("--- ")) {
      input.files[name = line.substr(4)];
    } else if (line.starts_with("--set ")) {
      std::istringstream words(line);
      std::copy_if(std::istream_iterator<std::string>(words), {}, std::back_inserter(input.settings),
                   [](const std::string& word) { return word != "--set"; });
    } else if (std::regex_match(line, match, replacement)) {
      const std::size_t number = std::stoul(match[1]);
      std::string& of_scene = input.files.at(name).at(number - 1);
      of_scene = (replaced.insert(number).second ? "" : of_scene + "\n") + match[2].str();
    } else {
      input.files[name].push_back(line);
    }
  }
  if (!answered && input.commands.empty())
    throw std::logic_error(fmt::format("{}, line {}: no answer", listed.group, listed.number));
  return input;
}

std::vector<Inputs> inputs_in(const std::string& file) {
  std::vector<Inputs> groups;
  for (const ListedCase& listed : cases_in(file)) {
    if (groups.empty() || groups.back().name != listed.group) groups.push_back({listed.group, {}});
    groups.back().all.push_back(input_of(listed));
  }
  return groups;
}

class Answers : public ProgramTest, public testing::WithParamInterface<Inputs> {
 protected:
  // What is in the folder, but for what the shell writes there.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      all[entry.path().string()] = entry.is_regular_file() ? contents(entry.path()) : "";
    all.erase(path(".out")), all.erase(path(".err"));
    return all;
  }

  // The message; nothing where the input is taken.
  std::string of_reading(const Input& input) const {
    try {
      const std::string name = input.files.begin()->first;
      if (name == "s.toml") {
        tools::parse_scene(input.text(name), name, input.settings);
      } else {
        std::istringstream list(input.text(name));
        tools::parse_list(list, name, tools::Run());
      }
      return "";
    } catch (const tools::Error& error) {
      EXPECT_EQ(static_cast<int>(error.status), input.status) << error.what();
      return error.what();
    }
  }

  // A command and what it prints. Status 77: what the case needs is not here.
  void try_out(const Command& command) const {
    const Printed printed = shell(command.typed);
    if (printed.status == 77) GTEST_SKIP() << "status 77: " << command.typed;
    EXPECT_EQ(printed.status, command.status) << command.typed << "\n" << printed.out << printed.err;
    for (const std::string& line : command.printed) {
      const std::string text = line.substr(2);
      if (line.starts_with("+ "))
        EXPECT_TRUE(has(printed.out, text)) << command.typed;
      else if (line.starts_with("- "))
        EXPECT_FALSE(has(printed.out, text)) << command.typed;
      else if (line.starts_with("= "))
        EXPECT_TRUE(has("\n" + printed.out, "\n" + text + "\n")) << command.typed;
      else if (line.starts_with("! "))
        EXPECT_TRUE(has(printed.err, text)) << command.typed;
      else
        ADD_FAILURE() << "neither a command nor what it prints: " << line;
    }
  }

  // The message of a refusal, which is all that it prints and leaves behind; nothing where all commands succeed.
  std::string of_commands(const Input& input) const {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) std::filesystem::remove_all(entry);
    for (const auto& [name, lines] : input.files) {
      std::filesystem::create_directories((folder / name).parent_path());
      write(name, input.text(name));
    }
    const Command& last = input.commands.back();
    for (const Command& one : input.commands)
      if (!IsSkipped() && (&one != &last || input.status == 0)) try_out(one);
    if (IsSkipped() || input.status == 0) return "";
    const auto before = files();
    const Printed printed = shell(last.typed, input.status);
    EXPECT_TRUE(files() == before) << "a file was made or changed";
    EXPECT_TRUE(begins(printed.err, "cradle: "));
    EXPECT_EQ(std::ranges::count(printed.err, '\n'), 1) << printed.err;
    return printed.err.substr(8, printed.err.size() - 9);
  }
};

TEST_P(Answers, AreThoseOfTheTable) {
  for (const Input& input : GetParam().all) {
    if (IsSkipped()) break;
    SCOPED_TRACE("line " + std::to_string(input.line));
    const std::string found = input.commands.empty() ? of_reading(input) : of_commands(input), wanted = input.message;
    if (wanted.ends_with("..."))
      EXPECT_TRUE(begins(found, wanted.substr(0, wanted.size() - 3)));
    else
      EXPECT_EQ(found, wanted);
  }
}

constexpr auto name_of = [](const auto& inputs) { return inputs.param.name; };
INSTANTIATE_TEST_SUITE_P(Input, Answers, testing::ValuesIn(inputs_in("messages.txt")), name_of);
INSTANTIATE_TEST_SUITE_P(Output, Answers, testing::ValuesIn(inputs_in("outputs.txt")), name_of);
INSTANTIATE_TEST_SUITE_P(OutputOfRuns, Answers, testing::ValuesIn(inputs_in("run/outputs.txt")), name_of);
INSTANTIATE_TEST_SUITE_P(OutputOfRanks, Answers, testing::ValuesIn(inputs_in("ensemble/outputs.txt")), name_of);

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
