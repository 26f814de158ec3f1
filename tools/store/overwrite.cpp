#include "cradle/tools/store/overwrite.hpp"
#include "cradle/tools/setup/read_scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "cradle/tools/result/files.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/unfinished.hpp"

namespace cradle::tools {

namespace {

std::string precision_words(const Run& run) {
  const std::string name = precision_name(run);
  const std::string digits = run.precision == Precision::mpfr ? fmt::format(" --set run.digits={}", run.digits) : "";
  return fmt::format(" --set 'run.precision={}'{}", name.substr(0, name.find(',')), digits);
}

[[noreturn]] void refuse(const std::string& file, const char* what, const std::string& found) {
  throw Error({file}, what, found, "give another -o FILE, or --force to replace it");
}

bool nothing_to_lose(const std::string& file) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return true;
  return std::filesystem::is_regular_file(file, none) && std::filesystem::file_size(file, none) == 0;
}

}  // namespace

std::string command_of(const Result& result) {
  if (const auto* command = find_attribute<std::string>(result.attributes, "command")) return *command;
  if (const Group* words = result.find("words"))
    if (const auto* command = find_attribute<std::string>(words->attributes, "command")) return *command;
  if (const auto* kind = find_attribute<std::string>(result.attributes, "kind")) return *kind;
  return "run";
}

void say_how_made(Result& result, const std::string& command, const Scene& requested) {
  const auto* precision = find_attribute<std::string>(result.attributes, "precision");
  const bool raised = precision != nullptr && *precision != precision_name(requested.run);
  result.attributes.emplace_back("command", command + (raised ? precision_words(requested.run) : ""));
}

void check_overwrite(const std::string& file, const std::string& command, const Scene* scene, Force force) {
  if (force == Force::yes || nothing_to_lose(file)) return;
  std::string held;
  Scene found;
  try {
    const Result result = read_result(file, Reading::ends);
    held = command_of(result);
    found = parse_scene(attribute<std::string>(result.attributes, "scene", file), file);
  } catch (const Error&) {
    refuse(file, "not a result that this command makes again", "something else");
  }
  if (scene != nullptr && held == command + precision_words(scene->run))
    found.run.precision = scene->run.precision, found.run.digits = scene->run.digits;
  else if (held != command)
    refuse(file, "holds the result of another command", fmt::format("cradle {}, here {}", held, command));
  const std::string difference = scene == nullptr ? "" : scene_difference(found, *scene);
  if (!difference.empty()) refuse(file, "holds a result of other settings", difference);
}

void check_overwrite(const std::string& file, const Result& made, Force force) {
  const Scene scene = parse_scene(attribute<std::string>(made.attributes, "scene", file), file);
  check_overwrite(file, command_of(made), &scene, force);
}

void check_overwrite(const std::string& file, Force force) {
  if (force == Force::yes || nothing_to_lose(file)) return;
  std::string begin(begin_of(Stored::checkpoint));
  begin.pop_back();  // the format: those of other versions are checkpoints too
  std::string found(begin.size(), '\0');
  std::ifstream(file, std::ios::binary).read(found.data(), static_cast<std::streamsize>(found.size()));
  if (found != begin) refuse(file, "not a saved simulation", "something else");
}

}  // namespace cradle::tools
