// The command line, and the options that commands share.
#include "cradle/tools/commands/commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "cradle/tools/result/files.hpp"
#include "cradle/tools/scene/fields.hpp"
#include "cradle/tools/setup/read_scene.hpp"
#include "cradle/tools/support/spelling.hpp"

namespace cradle::tools {

namespace {

const char* const whole_number = "N";

CLI::Validator within(WholeNumbers range) {
  const auto check = [range](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool whole = error == std::errc{} && end == text.data() + text.size();
    if (whole && number >= range.least && number <= range.most) return {};
    return fmt::format("not a whole number from {} to {} (found {})", range.least, range.most, text);
  };
  return CLI::Validator(check, "");
}

// An empty text would be taken for the default.
CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& text) { return text.empty() ? "nothing is given" : std::string(); }, "");
}

std::string with_example(const std::string& example, const std::string& ending) {
  return fmt::format("Example: {}\n{}", example, ending);
}

// The command as the user types it.
std::string words_of(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return program.get_name() + (chosen.empty() ? "" : " " + chosen.front()->get_name());
}

Error misread(const CLI::App& program, const std::string& wrong, const std::string& found) {
  return Error({}, wrong, found, fmt::format("see `{} --help`", words_of(program)));
}

// An option that the command does not have: a similar one, or the key of a scene that it means.
Error unknown_option(const CLI::App& program, const std::string& given) {
  const std::string option = given.substr(0, given.find('='));
  const CLI::App& command = *program.get_subcommands().front();
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options())
    for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
  const auto advise = [&](const std::string& meant) {
    return Error({}, "no such option", given,
                 fmt::format("did you mean {}? See `{} --help`", meant, words_of(program)));
  };
  if (std::ranges::find(names, "--set") != names.end())
    for (const Field& field : scene_fields())
      if (field.key.ends_with("." + option.substr(2))) return advise(fmt::format("--set {}=VALUE", field.key));
  const auto nearest = nearest_word(option, names);
  return nearest.empty() ? misread(program, "no such option", given) : advise(std::string(nearest));
}

}  // namespace

bool CommandText::takes(const std::string& argument) const {
  return std::any_of(options.begin(), options.end(),
                     [&](const OptionText& option) { return option.argument && option.names.front() == argument; });
}

Command::Command(CLI::App& command, Action& chosen, const std::string& ending)
    : command_(command), chosen_(chosen), ending_(ending) {
  command_.footer(ending_);
}

void Command::argument(const std::string& name, std::string& value, const std::string& help, Needed needed) {
  command_.add_option(name, value, help)->required(needed == Needed::yes)->type_name("")->check(not_empty());
}

void Command::arguments(const std::string& name, std::vector<std::string>& values, const std::string& help,
                        Needed needed) {
  command_.add_option(name, values, help)->required(needed == Needed::yes)->type_name("");
}

void Command::option(const std::string& names, std::string& value, const std::string& help, Needed needed) {
  command_.add_option(names, value, help)->required(needed == Needed::yes)->check(not_empty());
}

void Command::option(const std::string& names, std::optional<std::string>& value, const std::string& help) {
  command_.add_option(names, value, help)->check(not_empty());
}

void Command::option(const std::string& names, unsigned& value, const std::string& help) {
  command_.add_option(names, value, help)
      ->type_name(whole_number)
      ->check(within({0, std::numeric_limits<unsigned>::max()}));
}

void Command::option(const std::string& names, std::uint64_t& value, WholeNumbers range, const std::string& help,
                     Needed needed) {
  command_.add_option(names, value, help)
      ->required(needed == Needed::yes)
      ->type_name(whole_number)
      ->check(within(range));
}

void Command::repeated(const std::string& names, std::vector<std::string>& values, const std::string& help,
                       const std::string& kind) {
  command_.add_option(names, values, help)->type_name(kind)->allow_extra_args(false);
}

void Command::list(const std::string& names, std::vector<unsigned>& values, WholeNumbers range,
                   const std::string& help) {
  command_.add_option(names, values, help)
      ->type_name(fmt::format("{0},{0},", whole_number))
      ->delimiter(',')
      ->check(within(range))
      ->allow_extra_args(false);
}

void Command::flag(const std::string& names, bool& value, const std::string& help) {
  command_.add_flag(names, value, help);
}

void Command::note(const std::string& text) { command_.footer(text + "\n\n" + ending_); }

void Command::does(Action action) {
  command_.callback([&chosen = chosen_, action = std::move(action)] { chosen = action; });
}

CommandLine::CommandLine(const std::string& program, const std::string& description, const std::string& about_version,
                         const std::string& example, const std::string& ending)
    : program_(std::make_unique<CLI::App>(description, program)), ending_(ending) {
  program_->set_version_flag("--version", about_version);
  program_->require_subcommand(1);
  program_->footer(with_example(example, ending_));
}

CommandLine::~CommandLine() = default;

Command CommandLine::add(const std::string& name, const std::string& description, const std::string& example) {
  return {*program_->add_subcommand(name, description), chosen_, with_example(example, ending_)};
}

std::vector<CommandText> CommandLine::texts() const {
  std::vector<CommandText> texts;
  for (const CLI::App* command : program_->get_subcommands([](const CLI::App*) { return true; })) {
    CommandText& text = texts.emplace_back(command->get_name(), command->get_description());
    for (const CLI::Option* option : command->get_options()) {
      if (option == command->get_help_ptr()) continue;
      OptionText& of = text.options.emplace_back();
      of.argument = option->get_positional();
      of.help = option->get_description();
      if (of.argument) of.names = {option->get_name(true)};
      for (const auto& name : option->get_snames()) of.names.push_back("-" + name);
      for (const auto& name : option->get_lnames()) of.names.push_back("--" + name);
      if (!of.argument && option->get_items_expected_max() > 0) of.value = option->get_type_name();
    }
  }
  return texts;
}

Action CommandLine::read(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc > 1 && std::string_view(words[1]) == "help") {  // `help run` is `run --help`
    words.erase(words.begin() + 1);
    words.insert(words.begin() + (argc > 2 ? 2 : 1), "--help");
  }
  if (argc < 2 && !first_steps_.empty())
    return [this]() -> Exit {
      fmt::print("{}", first_steps_);
      throw Error({}, "no command", "", fmt::format("give one, see `{} --help`", program_->get_name()));
    };
  const char* const first = argc > 1 ? words[1] : "-";
  std::vector<std::string> names;
  for (const CommandText& command : texts()) names.push_back(command.name);
  if (*first != '-' && std::ranges::find(names, first) == names.end()) {
    const auto nearest = nearest_word(first, names);
    if (nearest.empty()) throw misread(*program_, "no such command", first);
    throw Error({}, "no such command", first, fmt::format("did you mean `{} {}`?", program_->get_name(), nearest));
  }
  try {
    program_->parse(argc, words.data());
    return chosen_;
  } catch (const CLI::ExtrasError&) {
    const std::vector<std::string> more = program_->remaining(true);
    if (more.front().starts_with("--") && !program_->get_subcommands().empty())
      throw unknown_option(*program_, more.front());
    const std::string command = words_of(*program_), found = fmt::format("{}", fmt::join(more, " "));
    if (command.ends_with(" plot"))
      throw Error({}, "more than this command takes", found,
                  "give one result at a time; several runs in one picture are in the manual's how-to-look.md");
    throw misread(*program_, "more than this command takes", found);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw misread(*program_, error.what(), "");
    std::ostringstream text;  // --help, --version
    program_->exit(error, text, text);
    return [text = text.str()] {
      fmt::print("{}", text);
      return Exit::done;
    };
  }
}

std::vector<std::string> CommonOptions::all_overrides() const {
  std::vector<std::string> all = overrides;
  if (seed) all.push_back("initial.seed=" + *seed);
  return all;
}

Scene CommonOptions::read() const {
  Scene read = read_scene(scene, all_overrides());
  if (!quiet) notify(read.remarks);
  return read;
}

FileClaim OutputOptions::claim(const std::string& file, const std::string& command, const Scene* scene) const {
  FileClaim claim(file);
  check_overwrite(file, command, scene, force());
  return claim;
}

void put_result(const Result& result, const std::string& output, const std::string& text, bool quiet) {
  write_or_keep(result, output);
  fmt::print("{}", text);
  if (!quiet) fmt::print("wrote {}\n", output);
}

void add_output_options(Command& command, OutputOptions& options, const std::string& what, Needed needed) {
  command.option("-o,--output", options.output, what, needed);
  command.flag("--force", options.forced, "replace what is there, also what this command would not make again");
}

void add_common_options(Command& command, CommonOptions& options) {
  command.argument("SCENE", options.scene, "scene file, or the name of a bundled scene");
  command.repeated("--set", options.overrides,
                   "table.key=value instead of what the scene says, table.key= to remove a key; may be repeated",
                   "KEY=VALUE");
  command.option("--seed", options.seed, "instead of initial.seed");
  add_running_options(command, options);
}

void add_running_options(Command& command, RunningOptions& options) {
  command.option("--threads", options.threads,
                 "threads to use at most, for replicas or for one run of many particles; 0: all processors; never "
                 "changes a result");
  command.flag("--quiet", options.quiet, "no messages but errors, the collapse report and warnings about the result");
  command.flag("--progress", options.progress,
               "report progress every ten seconds where standard error is not a terminal, instead of every minute");
}

}  // namespace cradle::tools
