// The manual page, in troff's man macros, from the commands and the table of keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/support/version.hpp"

namespace cradle::tools {

namespace {

// Escapes text for troff: backslashes, minus signs (else hyphens), and dots at the beginning of a line.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string entry(std::string_view head, std::string_view text) {
  return fmt::format(".TP\n.B {}\n{}\n", plain(head), plain(text));
}

std::string command_text(const CommandText& command) {
  std::string arguments, entries;
  for (const OptionText& option : command.options) {
    const std::string names = fmt::format("{}", fmt::join(option.names, ", "));
    if (option.argument) arguments += " " + names;
    entries += entry(names + (option.value.empty() ? "" : " " + option.value), option.help);
  }
  return fmt::format(".SS cradle {}{}\n{}.\n{}", plain(command.name), plain(arguments), plain(command.help), entries);
}

Exit manual(const CommandLine& program) {
  fmt::print(
      ".TH CRADLE 1 \"\" \"cradle {0}\" \"User Commands\"\n"
      ".SH NAME\ncradle \\- one\\-dimensional granular gases, event by event\n"
      ".SH SYNOPSIS\n.B cradle\n.I COMMAND\n[OPTIONS]\n"
      ".SH DESCRIPTION\nSimulates point particles on a line or a ring that collide by one of three laws: inelastic, "
      "wet, sticky. SCENE is a scene file or, where no such file exists, the name of a bundled scene. Results are HDF5 "
      "files. Tables go to standard output, messages and progress to standard error.\n"
      ".SH COMMANDS\n",
      version);
  for (const CommandText& command : program.texts()) fmt::print("{}", command_text(command));
  fmt::print(
      ".SH SCENE KEYS\nIn TOML. m is the mass of a single particle, l and t are the scene\\(aqs length and time.\n");
  for (const Field& field : scene_fields()) {
    const std::string with = field.when->text.empty() ? "" : fmt::format("; with {}", field.when->text);
    fmt::print("{}", entry(field.key, fmt::format("{} ({}{})", field.doc, facts(field), with)));
  }
  fmt::print(".SH EXIT STATUS\n{}{}{}{}{}{}{}{}{}", entry("0", "done"), entry("1", "a comparison differs"),
             entry("2", "bad input, the command line included"),
             entry("3", "stopped at inelastic collapse (policy stop)"),
             entry("4", "a file could not be read or written"),
             entry("5", "resolution or order of collisions lost, a replica failed, or a proof is undecided"),
             entry("6", "the processor lacks AVX2, BMI2 or FMA, for which the program was built"),
             entry("130, 143", "interrupted by SIGINT; by SIGTERM, SIGUSR1 or SIGHUP"),
             entry("141", "the program that read its output has ended (SIGPIPE, as the shell shows it)"));
  fmt::print(".SH ENVIRONMENT\n{}{}", entry("CRADLE_PYTHON", "the Python that makes pictures and reports"),
             entry("TMPDIR", "the folder for temporary files"));
  fmt::print(".SH FILES\n{}{}",
             entry("FILE.part", "what a run in progress has recorded; `cradle resume FILE` continues it"),
             entry("FILE.checkpoint", "its state, from which that is done"));
  return Exit::done;
}

}  // namespace

void add_manual(CommandLine& program) {
  Command command = program.add("manual", "the manual page, as troff", "cradle manual | man -l -");
  command.does([&program] { return manual(program); });
}

}  // namespace cradle::tools
