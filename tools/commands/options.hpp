// The command line as commands see it: a command declares its arguments and options, each bound to a variable of its
// own, and its action. Only options.cpp includes the library that parses them: included in every command, it took
// nearly a third of the program's compile time.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/support/errors.hpp"

namespace CLI {
class App;
}

namespace cradle::tools {

/// What the main program runs once the command line is read.
using Action = std::function<Exit()>;

enum class Needed { no, yes };

/// The whole numbers that an option accepts.
struct WholeNumbers {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
};

/// One command. An argument has a name, "FILE"; an option has one or two, "-o,--output". Reading the command line
/// writes the variables of the options that are given; the others keep their values, which are the defaults.
class Command {
 public:
  /// The help text ends with the note, if there is one, and `ending`.
  Command(CLI::App& command, Action& chosen, const std::string& ending);

  void argument(const std::string& name, std::string& value, const std::string& help, Needed needed = Needed::yes);
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help,
                 Needed needed = Needed::yes);

  void option(const std::string& names, std::string& value, const std::string& help, Needed needed = Needed::no);
  void option(const std::string& names, std::optional<std::string>& value, const std::string& help);
  void option(const std::string& names, unsigned& value, const std::string& help);
  void option(const std::string& names, std::uint64_t& value, WholeNumbers range, const std::string& help,
              Needed needed = Needed::no);
  /// --set A --set B; help calls a value `kind`.
  void repeated(const std::string& names, std::vector<std::string>& values, const std::string& help,
                const std::string& kind = "TEXT");
  /// --digits 16,31,50
  void list(const std::string& names, std::vector<unsigned>& values, WholeNumbers range, const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);

  void note(const std::string& text);
  void does(Action action);
  /// Makes the arguments of the command, which `run` gets when the command is chosen. The caller binds options to their
  /// members.
  template <class Arguments> Arguments& runs(Exit (*run)(const Arguments&)) {
    const auto arguments = std::make_shared<Arguments>();
    does([arguments, run] { return run(*arguments); });
    return *arguments;
  }

 private:
  CLI::App& command_;
  Action& chosen_;
  std::string ending_;
};

/// An option or an argument, as the help text shows it.
struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; for an argument its name, "SCENE"
  std::string value, help;         // value is empty for flags
  bool argument = false;
};
struct CommandText {
  std::string name, help;
  std::vector<OptionText> options;  // without --help

  bool takes(const std::string& argument) const;
};

/// All commands, and which of them was chosen.
class CommandLine {
 public:
  /// `ending` ends every help text.
  CommandLine(const std::string& program, const std::string& description, const std::string& about_version,
              const std::string& example, const std::string& ending);
  ~CommandLine();

  Command add(const std::string& name, const std::string& description, const std::string& example);

  /// Sets what is printed when no command is given.
  void begin_with(const std::string& text) { first_steps_ = text; }

  /// All commands with their options, for completion and the manual page.
  std::vector<CommandText> texts() const;

  /// The chosen command's action, or one that prints help or the version. Throws Error.
  Action read(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> program_;
  std::string ending_, first_steps_;
  Action chosen_;
};

}  // namespace cradle::tools
