// The command line: chooses a command, runs it and turns what goes wrong into one message and a documented exit status.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/support/version.hpp"

using namespace cradle::tools;

namespace {

int fail(std::string_view message, Exit status) {
  fmt::print(stderr, "cradle: {}\n", message);
  return static_cast<int>(status);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("One-dimensional granular gases, event by event: dry, wet and sticky, in any precision.", "cradle");
  program.set_version_flag("--version", build_description());
  program.require_subcommand(1);
  program.footer(
      "Exit status: 0 done, 1 a comparison differs, 2 bad input, 3 inelastic collapse, 4 file not read or written,\n"
      "5 resolution or order lost, 130/143 interrupted.");
  Action action;
  for (const auto add : {add_run, add_check, add_info, add_export, add_theory, add_scenes, add_plot, add_trust,
                         add_ensemble, add_sweep, add_merge})
    add(program, action);

  try {
    program.parse(argc, argv);
    return static_cast<int>(action());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    return fail(fmt::format("{}: see `cradle --help`", error.what()), Exit::bad_input);
  } catch (const Error& error) {
    return fail(error.what(), error.status);
  } catch (const std::bad_alloc&) {
    return fail("out of memory: see what `cradle check SCENE` expects", Exit::bad_input);
  } catch (const std::exception& error) {
    return fail(error.what(), Exit::bad_input);
  }
}
