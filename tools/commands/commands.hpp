// The commands of the program, one file each, and their list. Each adds itself to the command line: it declares its
// arguments and options, each bound to a variable of its own, and its action. When chosen, it does its work and returns
// an exit status; it throws Error for everything a user can put right. Only options.cpp includes the library that
// parses command lines: included in every command, it took nearly a third of the program's compile time.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cradle/tools/ensemble/ensemble.hpp"
#include "cradle/tools/result/result.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/support/atomic_file.hpp"
#include "cradle/tools/support/interrupt.hpp"
#include "cradle/tools/support/progress.hpp"

namespace CLI {
class App;
}

namespace cradle::tools {

class RunFiles;

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
  template <class Arguments> Arguments& runs(std::function<Exit(const Arguments&)> run) {
    const auto arguments = std::make_shared<Arguments>();
    does([arguments, run = std::move(run)] { return run(*arguments); });
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

/// How a command computes.
struct RunningOptions {
  unsigned threads = 0;
  bool quiet = false, progress = false;

  Progress::Show show() const {
    return progress ? Progress::Show::always : quiet ? Progress::Show::never : Progress::Show::on_terminal;
  }
};
void add_running_options(Command& command, RunningOptions& options);

/// Where a command writes.
struct OutputOptions {
  std::string output;
  bool forced = false;

  /// The place, or this one if none is given.
  std::string output_or(const std::string& standard) const { return output.empty() ? standard : output; }
  Force force() const { return forced ? Force::yes : Force::no; }
  /// Claims the file. Throws Error unless the result of this command may replace what is there.
  FileClaim claim(const std::string& file, const std::string& command, const Scene* scene) const;
};
/// `what` describes -o: "result file (default: ...)".
void add_output_options(Command& command, OutputOptions& options, const std::string& what, Needed needed = Needed::no);

/// Options that every command that computes a scene accepts.
struct CommonOptions : RunningOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<std::string> seed;

  /// The assignments of --set and --seed.
  std::vector<std::string> all_overrides() const;
  /// The scene; its remarks are printed, unless --quiet.
  Scene read() const;
};
void add_common_options(Command& command, CommonOptions& options);

/// What `run` and `resume` share: runs the scene of the files into `output`, which the caller has claimed, and reports
/// how it ended. `announcement`: for the user, before the run.
Exit run_command(RunFiles& files, const std::string& output, const RunningOptions& options, Interrupt& interrupt,
                 const std::string& announcement = "");

/// The most replicas, and the highest number of one: float64 counts exactly up to here.
inline constexpr std::uint64_t most_replicas = std::uint64_t{1} << 53;

struct StudyPlan {
  Study study;
  EnsembleOptions options;
  std::string output;
  std::string note = {};  // for the user
};

/// What `ensemble`, `sweep` and `resume` share: runs the replicas of the plan that its output does not have yet,
/// reports how they ended, and returns the exit status. Under MPI every rank makes the plan; an error in it is reported
/// once.
Exit run_study_command(bool quiet, const std::function<StudyPlan()>& make_plan);

/// Writes what a command has made, then prints `text` and, unless it is to be quiet, the name of the file.
void put_result(const Result& result, const std::string& output, const std::string& text, bool quiet);

/// A summary of a result: scene, precision, times, counts; `all`: also keys at their defaults. Needs only the first and
/// last rows of the columns. Throws Error if `file` holds no scene.
std::string listing(const Result& result, const std::string& file, bool all);

/// The Python package; names include the folders below tools/python.
std::span<const EmbeddedFile> python_package();

/// The commands: each adds itself. Help lists them in this order.
using AddCommand = void(CommandLine& program);
AddCommand add_run, add_resume, add_check, add_info, add_export, add_diff, add_theory, add_scenes, add_new, add_plot,
    add_report, add_cite, add_trust, add_certify, add_ensemble, add_sweep, add_merge, add_completion, add_manual,
    add_words, add_threshold;
inline constexpr AddCommand* all_commands[] = {
    add_run,      add_resume, add_check, add_info,       add_export, add_diff,  add_theory,
    add_scenes,   add_new,    add_plot,  add_report,     add_cite,   add_trust, add_certify,
    add_ensemble, add_sweep,  add_merge, add_completion, add_manual, add_words, add_threshold};

}  // namespace cradle::tools
