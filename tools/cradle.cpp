// The command line: chooses a command and runs it; turns an exception into one message and a documented exit status.

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/support/version.hpp"

using namespace cradle::tools;

namespace {

const char* const first_steps =
    R"(Cradle: one-dimensional granular gases, event by event. To begin with:

  cradle run fig2           two rows of inelastic particles run into each other: fig2.h5, in a second or two
  cradle plot fig2.h5       its pictures: fig2.png and others beside it
  cradle report fig2.h5     all about it on one page: fig2.html
  cradle new                a commented scene of your own, shock.toml, for `cradle run shock.toml`
  cradle scenes             the scenes that are there; `cradle scenes --keys` lists what a scene can say

`cradle --help` lists the commands, `cradle COMMAND --help` what one takes, `cradle manual | man -l -` has all.
)";

int fail(std::string_view message, Exit status) {
  notify(fmt::format("cradle: {}\n", message));
  return static_cast<int>(status);
}

// Fails unless all output was written: else a script would take half of the output for all of it.
int finish(Exit status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(status);
  return fail("standard output cannot be written: check where it goes, a full disk or a program that has ended",
              status == Exit::done ? Exit::io : status);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond `ulimit -f` then fails, as on a full disk
  static Interrupt unheeded;
  note_signals(unheeded);
  try {
    CommandLine program(
        "cradle", "One-dimensional granular gases, event by event: dry, wet and sticky, in any precision.",
        build_description(),
        "cradle run fig2 -o fig2.h5, then cradle plot fig2.h5; cradle run --help lists what else `run` takes",
        "Exit status: 0 done, 1 a comparison differs, 2 bad input, 3 inelastic collapse, 4 file not read or written,\n"
        "5 resolution or order lost, 6 processor too old for this build, 130/143 interrupted, 141 output closed.");
    program.begin_with(first_steps);
    for (AddCommand* const add : all_commands) add(program);
    return finish(program.read(argc, argv)());
  } catch (const Error& error) {
    return fail(error.what(), error.status);
  } catch (const std::system_error& error) {  // mostly from output
    return std::ferror(stdout) != 0 ? finish(Exit::done)
                                    : fail(fmt::format("{}: check where the output goes", error.what()), Exit::io);
  } catch (const std::length_error&) {
    return fail("out of memory: see what `cradle check SCENE` expects", Exit::bad_input);
  } catch (const std::bad_alloc&) {
    return fail("out of memory: see what `cradle check SCENE` expects", Exit::bad_input);
  } catch (const std::exception& error) {
    return fail(error.what(), Exit::bad_input);
  }
}
