// Completion of command lines in bash, zsh and fish, from the commands, the bundled scenes and the table of keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/scene/fields.hpp"

namespace cradle::tools {

namespace {

struct CompletionArguments {
  std::string shell;
};

std::string words(const std::vector<std::string>& all) { return fmt::format("{}", fmt::join(all, " ")); }

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& scene : bundled_scenes()) names.emplace_back(scene.name);
  return names;
}

std::vector<std::string> key_names() {
  std::set<std::string> names;
  for (const Field& field : scene_fields()) names.emplace(field.key);
  return {names.begin(), names.end()};
}

bool takes(const CommandText& command, const std::vector<std::string>& names) {
  return std::any_of(command.options.begin(), command.options.end(), [&](const OptionText& option) {
    return option.argument && std::find(names.begin(), names.end(), option.names.front()) != names.end();
  });
}
bool takes_scene(const CommandText& command) { return command.name == "scenes" || takes(command, {"SCENE"}); }

// Options whose values begin with a key.
bool of_keys(const OptionText& option) {
  return option.names.back() == "--set" || option.names.back() == "--vary" || option.names.back() == "--point";
}

std::string bash(const std::vector<CommandText>& commands) {
  std::string names, cases;
  for (const CommandText& command : commands) {
    names += " " + command.name;
    std::string options;
    for (const OptionText& option : command.options)
      if (!option.argument) options += " " + words(option.names);
    cases += fmt::format("    {}) options='--help{}' names={} ;;\n", command.name, options,
                         takes_scene(command) ? "$scenes" : "");
  }
  return fmt::format(
      R"(# bash completion of cradle: source it, or put it into a folder of completions under the name cradle.
_cradle() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} options= names=
  local scenes='{}'
  local keys='{}'
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '--help --version{}' -- "$word")
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $before in
    --set | --vary | --point)
      compopt -o nospace
      mapfile -t COMPREPLY < <(compgen -W "$keys" -S = -- "$word") ;;
    --from) mapfile -t COMPREPLY < <(compgen -W "$scenes" -- "$word"; compgen -f -- "$word") ;;
    completion) mapfile -t COMPREPLY < <(compgen -W 'bash zsh fish' -- "$word") ;;
    *)
      if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
      elif [[ -n $names ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word"; compgen -f -- "$word")
      fi ;;
  esac
}}
complete -o default -o bashdefault -F _cradle cradle
)",
      words(scene_names()), words(key_names()), names, cases);
}

// Within single quotes, and what zsh's _arguments takes for its own.
std::string quoted(const std::string& text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != special.npos) out += '\\';
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return "'" + out + "'";
}

std::string zsh(const std::vector<CommandText>& commands) {
  std::string names, cases;
  for (const CommandText& command : commands) {
    names += fmt::format("    {}\n", quoted(command.name + ":" + command.help, ""));
    cases += fmt::format("    {}) _arguments '--help'", command.name);
    for (const OptionText& option : command.options) {
      if (option.argument) continue;
      const char* const values = of_keys(option) ? "_cradle_keys" : option.value == "N" ? "" : "_files";
      for (const std::string& name : option.names) {
        std::string one = (of_keys(option) ? "*" : "") + name + "[";
        std::string help = quoted(option.help, ":[]\\");
        one += help.substr(1, help.size() - 2) + "]";
        if (!option.value.empty()) one += fmt::format(":{}:{}", "value", values);
        cases += " \\\n        '" + one + "'";
      }
    }
    cases += fmt::format(" \\\n        '*:file:{}' ;;\n", takes_scene(command) ? "_cradle_scenes" : "_files");
  }
  return fmt::format(R"(#compdef cradle
# zsh completion of cradle: put it into a folder of $fpath under the name _cradle.
_cradle_scenes() {{
  compadd {}
  _files
}}
_cradle_keys() {{ compadd -S = {}; }}
_cradle() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local chosen=$words[2]
  shift words
  ((CURRENT--))
  case $chosen in
{}  esac
}}
if [[ $funcstack[1] == _cradle ]]; then _cradle "$@"; else compdef _cradle cradle; fi
)",
                     words(scene_names()), words(key_names()), names, cases);
}

std::string fish(const std::vector<CommandText>& commands) {
  std::string text =
      "# fish completion of cradle: put it into ~/.config/fish/completions under the name cradle.fish.\n";
  for (const CommandText& command : commands) {
    const std::string chosen = fmt::format("-n '__fish_seen_subcommand_from {}'", command.name);
    text += fmt::format("complete -c cradle -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                        quoted(command.help, "\\"));
    if (takes_scene(command)) text += fmt::format("complete -c cradle {} -a '{}'\n", chosen, words(scene_names()));
    for (const OptionText& option : command.options) {
      if (option.argument) continue;
      text += "complete -c cradle " + chosen;
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (of_keys(option))
        text += fmt::format(" -x -a '{}='", fmt::join(key_names(), "= "));
      else if (!option.value.empty())
        text += option.value == "N" ? " -x" : " -r";
      text += " -d " + quoted(option.help, "\\") + "\n";
    }
  }
  return text;
}

Exit completion(const CommandLine& program, const std::string& shell) {
  for (const auto& [name, script] : {std::pair{"bash", &bash}, std::pair{"zsh", &zsh}, std::pair{"fish", &fish}})
    if (shell == name) {
      fmt::print("{}", script(program.texts()));
      return Exit::done;
    }
  throw Error({}, "no such shell", shell, "give bash, zsh or fish");
}

}  // namespace

void add_completion(CommandLine& program) {
  Command command = program.add("completion", "completion of command lines, as a script for bash, zsh or fish",
                                "source <(cradle completion bash)");
  const auto options = std::make_shared<CompletionArguments>();
  command.argument("SHELL", options->shell, "bash, zsh or fish");
  command.does([&program, options] { return completion(program, options->shell); });
}

}  // namespace cradle::tools
