// The commands of the program, one file each. A command adds itself to the command line and, when chosen, does its work
// and returns an exit status; it throws Error for everything a user can put right.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cradle/tools/scene/scene.hpp"
#include "cradle/tools/support/errors.hpp"

namespace CLI {
class App;
}

namespace cradle::tools {

/// What the main program runs once the command line is read.
using Action = std::function<Exit()>;

/// Options that every command that computes accepts.
struct CommonOptions {
  std::string scene;
  std::vector<std::string> overrides;
  std::optional<std::string> seed;
  unsigned threads = 0;
  bool quiet = false, progress = false;

  /// What --set and --seed say.
  std::vector<std::string> all_overrides() const;
  Scene read() const;
};
void add_common_options(CLI::App& command, CommonOptions& options);

void add_run(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_export(CLI::App& program, Action& action);
void add_theory(CLI::App& program, Action& action);
void add_scenes(CLI::App& program, Action& action);
void add_plot(CLI::App& program, Action& action);
void add_trust(CLI::App& program, Action& action);
void add_ensemble(CLI::App& program, Action& action);
void add_sweep(CLI::App& program, Action& action);
void add_merge(CLI::App& program, Action& action);

}  // namespace cradle::tools
