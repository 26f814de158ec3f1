// Completion of command lines. The scripts for the shells have a line or two each: they call the program with the words
// typed so far and show its output, one candidate per line followed by a tab and its meaning.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cradle/tools/commands/commands.hpp"
#include "cradle/tools/scene/fields.hpp"

namespace cradle::tools {

namespace {

constexpr const char* bash =
    R"(# bash completion of cradle: source it, or put it into a folder of completions under the name cradle.
_cradle() {
  local IFS=$'\n'
  mapfile -t COMPREPLY < <(cradle completion words -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null | cut -f 1)
  [[ ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
}
complete -o default -o bashdefault -F _cradle cradle
)";
constexpr const char* zsh = R"(#compdef cradle
# zsh completion of cradle: put it into a folder of $fpath under the name _cradle.
_cradle() {
  local -a found=("${(@f)$(cradle completion words -- "${(@)words[2,CURRENT]}" 2>/dev/null | cut -f 1)}")
  compadd -S '' -- ${found:#^*=}
  compadd -- ${found:#*=}
  _files
}
if [[ $funcstack[1] == _cradle ]]; then _cradle "$@"; else compdef _cradle cradle; fi
)";
constexpr const char* fish =
    R"(# fish completion of cradle: put it into ~/.config/fish/completions under the name cradle.fish.
complete -c cradle -a '(cradle completion words -- (commandline -opc)[2..] (commandline -ct) 2>/dev/null)'
)";

struct CompletionArguments {
  std::string shell;
  std::vector<std::string> words;
};

// Candidates for the last of the words, which is being typed: pairs of a word and its meaning.
std::vector<std::pair<std::string, std::string>> candidates(const std::vector<CommandText>& commands,
                                                            const std::vector<std::string>& words) {
  std::vector<std::pair<std::string, std::string>> all;
  if (words.size() < 2) {
    for (const CommandText& command : commands) all.emplace_back(command.name, command.help);
    all.emplace_back("--help", ""), all.emplace_back("--version", "");
    return all;
  }
  const auto command = std::ranges::find(commands, words[0], &CommandText::name);
  if (command == commands.end()) return all;
  const std::string &before = words[words.size() - 2], &word = words.back();
  if (before == "--set" || before == "--vary" || before == "--point") {
    for (const Field& field : scene_fields()) all.emplace_back(std::string(field.key) + "=", field.doc);
  } else if (word.starts_with('-')) {
    all.emplace_back("--help", "");
    for (const OptionText& option : command->options)
      for (const std::string& name : option.names)
        if (!option.argument) all.emplace_back(name, option.help);
  } else if (before == "--from" || command->name == "scenes" || command->takes("SCENE")) {
    for (const EmbeddedFile& scene : bundled_scenes()) all.emplace_back(scene.name, "");
  } else if (before == "completion") {
    for (const char* shell : {"bash", "zsh", "fish"}) all.emplace_back(shell, "");
  }
  return all;
}

Exit completion(const CommandLine& program, const CompletionArguments& arguments) {
  for (const auto& [name, script] : {std::pair{"bash", bash}, {"zsh", zsh}, {"fish", fish}})
    if (arguments.shell == name) {
      fmt::print("{}", script);
      return Exit::done;
    }
  if (arguments.shell != "words") throw Error({}, "no such shell", arguments.shell, "give bash, zsh or fish");
  const std::string typed = arguments.words.empty() ? "" : arguments.words.back();
  std::set<std::string> printed;  // several rows of the table may have the same key
  for (const auto& [word, meaning] : candidates(program.texts(), arguments.words))
    if (word.starts_with(typed) && printed.insert(word).second) fmt::print("{}\t{}\n", word, meaning);
  return Exit::done;
}

}  // namespace

void add_completion(CommandLine& program) {
  Command command = program.add("completion", "completion of command lines, as a script for bash, zsh or fish",
                                "source <(cradle completion bash)");
  auto& arguments = command.runs<CompletionArguments>(
      [&program](const CompletionArguments& given) { return completion(program, given); });
  command.argument("SHELL", arguments.shell, "bash, zsh or fish; or words, which prints what may follow WORD");
  command.arguments("WORD", arguments.words, "the words typed so far, behind --", Needed::no);
}

}  // namespace cradle::tools
