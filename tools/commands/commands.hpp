// The commands of the program, one file each, and their list. Each adds itself to the command line. When chosen, it
// does its work and returns an exit status; it throws Error for everything a user can put right.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cradle/tools/commands/options.hpp"
#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/support/progress.hpp"

namespace cradle::tools {

class Interrupt;
class RunFiles;

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

/// Writes what a command has made, then prints `text` and, unless it is to be quiet, the name of the file.
void put_result(const Result& result, const std::string& output, const std::string& text, bool quiet);

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
